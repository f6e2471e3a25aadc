"""Size functions that a .geo defines: ONELAB strings, which stock gmsh shows and ignores."""


import gmsh
import pytest

from program import run

BOXES = """
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 1, 1, 1};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Physical Surface("wing") = {1};
Physical Volume("left part") = {1};
Physical Volume("right") = {2};
"""
FIXED = "fixed source Surface{1} attach Volume{1} size 0.1 growth 1.3 limit 0.5"
MESH = "mesh source Surface{2} attach Volume{2} growth 1.3 limit 0.5"
DEFINED = BOXES + """
face = 1;
DefineConstant[
  first = {Sprintf("fixed source Surface{%%g} attach Volume{1} size %%g growth 1.3 limit 0.5", face,
                   0.2 / 2), Name "Size functions/a rim", ReadOnly 1}
];
DefineConstant[ second = {"%s", Name "Size functions/b/inner", ReadOnly 1} ];
DefineConstant[ third = {"", Name "Size functions/c empty", ReadOnly 1} ];
DefineConstant[ fourth = {"fixed source nonsense", Name "Other/Size functions/no"} ];
DefineConstant[ size = {0.1, Name "Size functions/a number"} ];
""" % MESH


def mesh(model, out, *arguments):
    result = run("mesh", model, "-3", "-o", out, *arguments)
    assert result.returncode == 0, result.stderr
    return result.stdout


@pytest.fixture
def write(tmp_path):
    def write_model(text, name="model.geo"):
        path = tmp_path / name
        path.write_text(text)
        return path
    return write_model


def test_definitions_make_the_mesh_that_the_command_line_makes(write, tmp_path):
    text = mesh(write(DEFINED), tmp_path / "a.msh")
    mesh(write(BOXES, "plain.geo"), tmp_path / "b.msh", "--size-function", FIXED,
         "--size-function", MESH)
    assert (tmp_path / "a.msh").read_bytes() == (tmp_path / "b.msh").read_bytes()
    assert "'a rim'" in text and "'b/inner'" in text
    assert "empty" not in text and "nonsense" not in text


def test_definitions_add_to_those_of_the_command_line_and_of_a_file(write, tmp_path):
    (tmp_path / "sizes.txt").write_text(MESH.replace("Surface{2}", "Surface{3}") + "\n")
    text = mesh(write(DEFINED), tmp_path / "a.msh", "--size-functions", tmp_path / "sizes.txt",
                "--size-function", FIXED.replace("0.1", "0.2"))
    # Those of the model first, by name.
    assert all(kind in text for kind in (
        'Fixed size function "a rim"', 'Mesh size function "b/inner"', "Fixed size function 3",
        "Mesh size function 4"))


def test_definitions_are_in_the_tree_that_gmsh_shows(write):
    gmsh.open(str(write(DEFINED)))
    names = gmsh.onelab.getNames("Size functions.*inner")
    assert list(names) == ["Size functions/b/inner"]
    assert list(gmsh.onelab.getString(names[0])) == [MESH]
    assert list(gmsh.onelab.getString("Size functions/a rim")) == [FIXED]


def test_physical_names_need_no_quotes(write, tmp_path):
    define = 'DefineConstant[ s = {"%s", Name "Size functions/s", ReadOnly 1} ];\n'
    mesh(write(BOXES + define % FIXED), tmp_path / "tags.msh")
    names = FIXED.replace("Surface{1}", "Physical Surface{wing}")
    names = names.replace("Volume{1}", "Physical Volume{left part}")
    mesh(write(BOXES + define % names), tmp_path / "names.msh")
    assert (tmp_path / "tags.msh").read_bytes() == (tmp_path / "names.msh").read_bytes()


def test_an_unusable_definition_is_named(write, tmp_path):
    model = write(DEFINED.replace("growth 1.3 limit 0.5", "growth 0.3 limit 0.5"))
    result = run("mesh", model, "-o", tmp_path / "out.msh")
    assert result.returncode == 2
    assert "Size functions/a rim" in result.stderr and "growth rate" in result.stderr
    assert not (tmp_path / "out.msh").exists()


def test_a_value_from_the_command_line_reaches_the_definition(write, tmp_path):
    model = write(BOXES + """
DefineConstant[ h = 0.1 ];
DefineConstant[ s = {Sprintf("fixed source Surface{1} attach Volume{1} size %g growth 1.3 limit 1",
                             h), Name "Size functions/s", ReadOnly 1} ];
""")
    assert "size 0.1 " in mesh(model, tmp_path / "a.msh")
    assert "size 0.2 " in mesh(model, tmp_path / "b.msh", "-setnumber", "h", "0.2")


def test_report_measures_against_the_definitions_of_each_file(write, tmp_path):
    mesh(write(DEFINED), tmp_path / "mesh.msh")
    with_sizes = write(DEFINED + 'Merge "mesh.msh";\n', "with.geo")
    without = write(BOXES + 'Merge "mesh.msh";\n', "without.geo")
    result = run("report", with_sizes, without, "--fail-if", "length_median < 0.5")
    lines = result.stdout.splitlines()
    columns = [line.split() for line in lines[1:]]
    assert columns[0][6] != "-" and columns[1][6] == "-"
    assert result.returncode == 1 and "without.geo: length_median is unknown" in result.stderr


def test_what_defines_nothing_is_told(write, tmp_path):
    result = run("mesh", write(DEFINED), "-1", "-o", tmp_path / "a.msh")
    assert result.returncode == 0
    told = [line for line in (result.stdout + result.stderr).splitlines()
            if "makes no size function" in line]
    assert len(told) == 2
    assert "Size functions/a number is a number" in told[0]
    assert "Size functions/c empty is empty" in told[1]
