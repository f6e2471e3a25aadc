"""The program `meshgrow`: what it does, and one sentence for each bad input."""

import json
import os
import re

import gmsh
import pytest

from program import run

BOX = """
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 1, 1, 1};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Physical Volume("left part") = {1};
Physical Volume("right") = {2};
Mesh.SaveAll = 1;
"""
FIXED = "fixed source Surface{1} attach Physical Volume{left part} size 0.1 growth 1.3 limit 0.5"
MESH = "mesh source Surface{2} attach Volume{2} growth 1.3 limit 0.5"


@pytest.fixture
def box(tmp_path):
    path = tmp_path / "box.geo"
    path.write_text(BOX)
    return path


def mesh(*arguments):
    result = run("mesh", *arguments)
    assert result.returncode == 0, result.stderr
    return result.stdout


def assert_refused(result, *words):
    """Non-zero exit and one line of error with these words."""
    assert result.returncode != 0
    lines = [line for line in result.stderr.splitlines() if line.startswith("meshgrow: ")]
    assert len(lines) == 1, result.stderr
    for word in words:
        assert word in lines[0]


def test_meshes_a_model_and_tells_what_comes_next(box, tmp_path):
    out = tmp_path / "out.msh"
    text = mesh(box, "-3", "-o", out, "--size-function", FIXED, "--size-function", MESH,
                "--evaluator", "grid")
    assert out.stat().st_size > 1000
    assert "Meshing, pass 1" in text
    assert "Background grid" in text
    assert "ratio max" in text
    assert "gmsh %s" % out in text


def test_default_output_stands_beside_the_model(box):
    mesh(box, "-2")
    assert box.with_suffix(".msh").exists()


def test_size_functions_come_from_a_file_too(box, tmp_path):
    definitions = tmp_path / "sizes.txt"
    definitions.write_text("# comment\n\n%s\n  %s  \n" %
                           (FIXED.replace("size 0.1", "size 0.05"), MESH))
    coarse = mesh(box, "-3", "-o", tmp_path / "coarse.msh")
    fine = mesh(box, "-3", "-o", tmp_path / "fine.msh", "--size-functions", definitions)
    assert "No size function is given" in coarse
    assert "Mesh size function 2" in fine
    assert (tmp_path / "fine.msh").stat().st_size > 3 * (tmp_path / "coarse.msh").stat().st_size


def test_report_compares_meshes_and_measures_sizes_from_the_file_alone(box, tmp_path):
    files = [tmp_path / "a.msh", tmp_path / "b.msh"]
    mesh(box, "-3", "-o", files[0])
    mesh(box, "-3", "-o", files[1], "--size-function", FIXED)
    result = run("report", *files, "--json", "--entities", 'Physical Volume{"left part"}',
                 "--size-function", FIXED.replace("fixed", "mesh").replace(" size 0.1", ""))
    assert result.returncode == 0, result.stderr
    rows = json.loads(result.stdout)
    assert [row["name"] for row in rows] == [str(f) for f in files]
    assert rows[1]["report"]["elements"] > rows[0]["report"]["elements"]
    assert 0.8 < rows[1]["report"]["length_median"] < 1.6
    table = run("report", *files).stdout
    assert len(table.splitlines()) == 3


def test_report_against_a_saved_field_is_that_against_its_functions(box, tmp_path):
    mesh(box, "-3", "-o", tmp_path / "a.msh", "--size-function", FIXED)
    saved = tmp_path / "sizes.mgf"
    assert run("field", box, "-o", saved, "--evaluator", "exact", "--size-function",
               FIXED).returncode == 0
    against = [json.loads(run("report", tmp_path / "a.msh", "--json", *options).stdout)
               for options in (["--sizes", saved], [])]
    assert 0.8 < against[0][0]["report"]["length_median"] < 1.6
    assert against[1][0]["report"]["length_median"] is None
    assert_refused(run("report", tmp_path / "a.msh", "--sizes", saved, "--size-function", FIXED),
                   "saved size field")
    assert_refused(run("report", tmp_path / "a.msh", "--sizes", box), "no size field")


def test_report_of_a_mesh_of_some_entities_says_nothing_but_its_table(box, tmp_path):
    box.write_text(box.read_text().replace("Mesh.SaveAll = 1;", "Mesh.SaveAll = 0;"))
    mesh(box, "-3", "-o", tmp_path / "a.msh")
    result = run("report", tmp_path / "a.msh")
    assert len(result.stdout.splitlines()) == 2, result.stdout
    assert result.stderr == ""


def test_two_dimensional_report(box, tmp_path):
    mesh(box, "-2", "-o", tmp_path / "a.msh")
    result = run("report", tmp_path / "a.msh", "--dim", 2, "--json")
    assert json.loads(result.stdout)[0]["report"]["elements"] > 10


@pytest.mark.parametrize("function, words", [
    ("mesh source Surface{2} attach Volume{2} growth 0.9 limit 1", ["growth rate", "0.9"]),
    ("mesh source Surface{2} attach Volume{2} growth nan limit 1", ["growth rate", "nan"]),
    ("mesh source Surface{2} attach Volume{2} growth 1.2 limit -1", ["size limit", "-1"]),
    ("mesh source Surface{2} attach Volume{2} growth 1.2 limit nan", ["size limit", "nan"]),
    ("mesh source Surface{99} attach Volume{2} growth 1.2 limit 1", ["Surface 99"]),
    ("mesh source Surface{2} attach Volume{7} growth 1.2 limit 1", ["Volume 7"]),
    ("mesh source Surface{2} attach Physical Volume{lost} growth 1.2 limit 1", ["lost"]),
    ("mesh source Surface{2} attach Surface{2} growth 1.2 limit 1",
     ["Surface 2", "source and attachment"]),
    ("fixed source Surface{2} attach Volume{2} size 0 growth 1.2 limit 1", ["'size'"]),
    ("mesh source Surface{2} attach Volume{2} grow 1.2 limit 1", ["position 41", "'growth'"]),
    ("", ["'mesh', 'fixed', 'curvature' or 'proximity'"]),
])
def test_bad_size_function_is_refused_and_nothing_is_written_over(box, tmp_path, function, words):
    out = tmp_path / "out.msh"
    out.write_text("precious")
    assert_refused(run("mesh", box, "-3", "-o", out, "--size-function", function), *words)
    assert out.read_text() == "precious"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["box.geo", "out.msh"]


def test_strict_refuses_a_source_that_will_have_no_mesh(box, tmp_path):
    # Up to dimension 1, the source surface is not meshed before the curves that grow from it.
    arguments = ["mesh", box, "-1", "-o", tmp_path / "out.msh", "--size-function",
                 "mesh source Surface{1} attach Volume{2} growth 1.2 limit 1"]
    assert_refused(run(*arguments, "--strict"), "Surface 1", "no mesh")
    relaxed = run(*arguments)
    assert relaxed.returncode == 0
    assert "Surface 1 has no mesh" in relaxed.stdout + relaxed.stderr


@pytest.mark.parametrize("content, words", [
    (None, ["Cannot read"]),
    ("this is no geometry {", ["Gmsh cannot read"]),
    ("", ["no geometry"]),
])
def test_unreadable_model(tmp_path, content, words):
    model = tmp_path / "model.geo"
    if content is not None:
        model.write_text(content)
    assert_refused(run("mesh", model, "-o", tmp_path / "out.msh"), "model.geo", *words)
    assert not (tmp_path / "out.msh").exists()


def test_a_directory_is_no_model(tmp_path):
    assert_refused(run("mesh", tmp_path, "-o", tmp_path / "out.msh"), str(tmp_path), "directory")
    assert list(tmp_path.iterdir()) == []


def test_no_place_for_temporary_files(box, tmp_path):
    assert_refused(run("mesh", box, "-2", "-o", tmp_path / "out.msh", "--size-function", FIXED,
                       TMPDIR=str(tmp_path / "missing")), "TMPDIR")
    assert not (tmp_path / "out.msh").exists()


def test_unreadable_file_of_size_functions(box, tmp_path):
    assert_refused(run("mesh", box, "-o", tmp_path / "out.msh", "--size-functions",
                       tmp_path / "missing.txt"), "missing.txt")
    assert_refused(run("mesh", box, "-o", tmp_path / "out.msh", "--size-functions", tmp_path),
                   "directory")


def test_an_endless_file_of_size_functions_fills_no_memory(box, tmp_path):
    assert_refused(run("mesh", box, "-o", tmp_path / "out.msh", "--size-functions", "/dev/zero"),
                   "/dev/zero has more than 64 MB")


def test_unwritable_output(box, tmp_path):
    assert_refused(run("mesh", box, "-o", tmp_path / "missing" / "out.msh"), "Cannot write")
    assert_refused(run("mesh", box, "-o", tmp_path), "Cannot write")


def test_the_model_is_never_written_over(tmp_path, box):
    mesh(box, "-3", "-o", tmp_path / "old.msh")
    before = (tmp_path / "old.msh").read_bytes()
    assert_refused(run("mesh", tmp_path / "old.msh", "-3"), "written over")
    assert (tmp_path / "old.msh").read_bytes() == before


def test_output_in_an_unknown_format(box, tmp_path):
    assert_refused(run("mesh", box, "-3", "-o", tmp_path / "out.nonsense"), "out.nonsense")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["box.geo"]


def test_report_of_a_model_without_elements(box):
    assert_refused(run("report", box), "no elements of dimension 3", "box.geo")


def test_no_libgmsh(box):
    assert_refused(run("mesh", box, MESHGROW_GMSH_LIB="/nowhere/libgmsh.so"), "MESHGROW_GMSH_LIB")


@pytest.mark.parametrize("arguments, words", [
    ([], ["subcommand", "meshgrow --help"]),
    (["mesh"], ["models", "meshgrow mesh --help"]),
    (["weave"], ['no command "weave"', "mesh, report, field, probe, serve"]),
    (["mesh", "a.geo", "--nonsense"], ["--nonsense"]),
    (["mesh", "a.geo", "--evaluator", "best"], ["--evaluator", "best"]),
    (["report", "a.msh", "--dim", "4"], ["--dim", "4"]),
    (["probe", "a.geo"], ["--at"]),
])
def test_wrong_command_line(arguments, words):
    result = run(*arguments)
    assert result.returncode == 2
    assert_refused(result, *words)
    assert len(result.stderr.splitlines()) == 1 and result.stderr.endswith(".\n")


def test_exit_codes(box, tmp_path):
    """2 for what was typed wrongly, 1 for what did not work."""
    out = tmp_path / "out.msh"
    assert run("mesh", box, "-2", "-o", out, "--size-function", "fixed").returncode == 2
    assert run("mesh", box, "-2", "-o", out, "--evaluator", "best").returncode == 2
    assert run("mesh", tmp_path / "no.geo", "-o", out).returncode == 2
    assert run("mesh", box, "-o", tmp_path / "no" / "out.msh").returncode == 2
    assert run("report", box).returncode == 2
    assert run("mesh", box, "-1", "-o", out, "--strict", "--size-function",
               "mesh source Surface{1} attach Volume{2} growth 1.2 limit 1").returncode == 1
    assert run("mesh", box, MESHGROW_GMSH_LIB="/nowhere/libgmsh.so").returncode == 1
    assert run("mesh", box, "-2", "-o", out).returncode == 0


@pytest.mark.parametrize("command", ["mesh", "report"])
def test_help_shows_an_example_and_the_exit_codes(command):
    result = run(command, "--help")
    assert result.returncode == 0
    assert "meshgrow %s " % command in result.stdout.split("Example:")[1]
    assert "Exit codes: 0 done; 1 " in result.stdout


def test_version_names_the_gmsh_that_is_found():
    path = os.environ["MESHGROW_GMSH_LIB"]
    version = gmsh.option.getString("General.Version")
    assert re.fullmatch(r"meshgrow \d+\.\d+\.\d+ with Gmsh %s \(%s\)\n" % (
        re.escape(version), re.escape(path)), run("--version").stdout)
    without = run("--version", MESHGROW_GMSH_LIB="/nowhere/libgmsh.so")
    assert without.returncode == 0
    assert re.match(r"meshgrow \d+\.\d+\.\d+ without Gmsh \(", without.stdout)


def test_unknown_option_is_named(box):
    result = run("mesh", box, "--nonsense")
    assert result.returncode != 0
    assert "--nonsense" in result.stderr + result.stdout


def test_plan_prints_the_passes_and_meshes_nothing(box, tmp_path):
    out = tmp_path / "out.msh"
    text = mesh(box, "--plan", "-o", out, "--size-function", FIXED, "--size-function", MESH)
    assert not out.exists() and "Meshing" not in text
    passes = [line for line in text.splitlines() if line.startswith("Pass ")]
    assert passes[0].startswith("Pass 1: dimension 1, Curve ")
    assert passes[-1] == "Pass %d: dimension 3, Volume 1 and Volume 2" % len(passes)
    assert "sizes from Fixed size function 1" in text and "reads Surface 2" in text


def test_functions_that_wait_for_each_other_are_refused_with_the_cycle(box):
    result = run("mesh", box, "--plan",
                 "--size-function", "mesh source Surface{1} attach Surface{3} growth 1.2 limit 1",
                 "--size-function", "mesh source Surface{3} attach Surface{1} growth 1.2 limit 1")
    assert_refused(result, "Surface 1 grows from Surface 3 by Mesh size function 2",
                   "which grows from Surface 1 by Mesh size function 1")


def test_remesh_meshes_again_what_is_no_source(box, tmp_path):
    """The mesh is kept beside its geometry: a second .geo merges both."""
    first, again = tmp_path / "first.msh", tmp_path / "again.msh"
    mesh(box, "-3", "-o", first, "--size-function", FIXED)
    both = tmp_path / "both.geo"
    both.write_text(BOX + 'Merge "first.msh";\n')
    texts = [mesh(both, "-3", "-o", again, *remesh, "--size-function",
                  "fixed source Volume{1} attach Volume{1} size 0.05 growth 1.2 limit 0.05")
             for remesh in ([], ["--remesh"])]
    assert "Meshing, pass" not in texts[0] and "Meshing, pass" in texts[1]


def test_calibrated_sizes_make_more_elements(box, tmp_path):
    sizes = []
    for extra in ([], ["--calibrate"]):
        out = tmp_path / "out.msh"
        mesh(box, "-3", "-o", out, "--size-function", FIXED, *extra)
        sizes.append(out.stat().st_size)
    assert sizes[1] > 1.2 * sizes[0]
