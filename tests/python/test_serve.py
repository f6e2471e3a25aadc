"""`meshgrow serve`: sizes for stock Gmsh, which starts it and asks through pipes."""

import json
import math
import os
import shutil
import subprocess
import sys

import gmsh
import numpy as np
import pytest

import meshgrow

from program import PROGRAM

EXAMPLES = os.path.join(os.path.dirname(__file__), "..", "..", "examples")
# The program of the same generation stands beside this Python.
GMSH = os.path.join(os.path.dirname(sys.executable), "gmsh")
END = np.full(3, math.nan).tobytes()
LEFT = "mesh source Curve{4} attach Surface{1} growth 1.2 limit 0.5"
RIGHT = "fixed source Curve{7} attach Surface{2} size 0.02 growth 1.5 limit 0.3"


@pytest.fixture
def two_squares(tmp_path):
    """Two unit squares side by side, with meshed curves: the model and its mesh file."""
    gmsh.model.add("squares")
    occ = gmsh.model.occ
    left, right = occ.addRectangle(0, 0, 0, 1, 1), occ.addRectangle(1, 0, 0, 1, 1)
    occ.fragment([(2, left)], [(2, right)])
    occ.synchronize()
    gmsh.model.addPhysicalGroup(2, [1], 9)
    gmsh.model.setPhysicalName(2, 9, "left part")
    gmsh.model.mesh.setTransfiniteCurve(4, 21)
    gmsh.model.mesh.generate(1)
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    path = str(tmp_path / "squares.msh")
    gmsh.write(path)
    return path


def serve(request, *arguments):
    return subprocess.run([PROGRAM, "serve", *map(str, arguments)], input=request,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60)


def functions(*texts):
    return [word for text in texts for word in ("--size-function", text)]


def answers(result):
    return np.frombuffer(result.stdout)


def points_around(count=500):
    return np.random.default_rng(7).uniform((-0.2, -0.2, 0), (2.2, 1.2, 0), (count, 3))


def test_smallest_size_of_all_groups_and_of_one_entity(two_squares):
    field = meshgrow.SizeField(evaluator="exact")
    field.add(LEFT)
    field.add(RIGHT)
    points = points_around()
    sizes = {tag: field.size(2, tag, points) for tag in (1, 2)}
    assert not np.array_equal(*sizes.values())
    request = points.tobytes() + END
    both = serve(request, two_squares, *functions(LEFT, RIGHT))
    assert both.returncode == 0, both.stderr
    np.testing.assert_allclose(answers(both), np.minimum(sizes[1], sizes[2]), rtol=1e-12)
    for tag in (1, 2):
        one = serve(request, two_squares, "--entity", "2,%d" % tag, *functions(LEFT, RIGHT))
        np.testing.assert_allclose(answers(one), sizes[tag], rtol=1e-12)


def test_grid_is_within_its_tolerance(two_squares):
    request = points_around().tobytes()
    exact = answers(serve(request, two_squares, *functions(LEFT)))
    grid = answers(serve(request, two_squares, *functions(LEFT), "--evaluator", "grid",
                         "--tolerance", 0.02))
    assert np.all(grid <= 1.02 * exact)
    assert np.all(grid >= 0.9 * exact)


def test_names_of_physical_groups_and_a_file_of_functions(two_squares, tmp_path):
    named = tmp_path / "sizes.txt"
    named.write_text(LEFT.replace("Surface{1}", "Physical Surface{left part}") + "\n# comment\n")
    request = points_around(10).tobytes()
    result = serve(request, two_squares, "--size-functions", named)
    assert result.stdout == serve(request, two_squares, *functions(LEFT)).stdout
    assert len(result.stdout) == 80 and result.stderr == b""


def test_inside_a_source_volume_only_there(tmp_path):
    """The size that a fixed function has inside its source volume is not that of all the space."""
    gmsh.model.add("boxes")
    occ = gmsh.model.occ
    occ.fragment([(3, occ.addBox(0, 0, 0, 1, 1, 1))], [(3, occ.addBox(1, 0, 0, 3, 1, 1))])
    occ.synchronize()
    gmsh.write(str(tmp_path / "boxes.brep"))
    text = "fixed source Volume{1} attach Volume{1,2} size 0.1 growth 1.2 limit 2"
    request = np.array([[0.5, 0.5, 0.5], [3.4, 0.5, 0.5]]).tobytes()
    sizes = answers(serve(request, tmp_path / "boxes.brep", *functions(text)))
    np.testing.assert_allclose(sizes, [0.1, 0.1 + 2.4 / 6], rtol=1e-6)


def test_no_size_for_points_without_one(two_squares):
    points = np.array([[math.inf, 0, 0], [0, 0, -math.inf], [0, math.nan, 0], [0.5, 0.5, 0]])
    result = serve(points.tobytes(), two_squares, *functions(LEFT))
    assert list(answers(result)[:3]) == [1e22] * 3
    assert answers(result)[3] < 0.5


def test_input_from_a_file_and_ends_of_input(two_squares, tmp_path):
    request = points_around(3).tobytes()
    (tmp_path / "requests").write_bytes(request)
    with open(tmp_path / "requests") as file:
        result = subprocess.run([PROGRAM, "serve", two_squares, *functions(LEFT)], stdin=file,
                                stdout=subprocess.PIPE)
    assert result.returncode == 0 and len(result.stdout) == 24
    half = serve(request + b"12345", two_squares, *functions(LEFT))
    assert half.returncode == 1 and len(half.stdout) == 24
    assert half.stderr.decode().startswith("meshgrow: The input ended within a request")
    assert serve(b"", two_squares, *functions(LEFT)).returncode == 0


def test_a_reader_that_is_gone_is_a_clean_end(two_squares):
    server = subprocess.Popen([PROGRAM, "serve", two_squares, *functions(LEFT)],
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE)
    server.stdin.write(points_around(1).tobytes())
    server.stdin.flush()
    assert len(server.stdout.read(8)) == 8
    server.stdout.close()
    server.stdin.write(points_around(1).tobytes())
    server.stdin.flush()
    assert server.wait(60) == 0
    assert server.stderr.read() == b""
    server.stderr.close()
    server.stdin.close()


@pytest.mark.parametrize("arguments, words", [
    (["missing.msh", *functions(LEFT)], "missing.msh"),
    (["{mesh}"], "No size function"),
    (["{mesh}", *functions("mesh source Curve{99} attach Surface{1} growth 1.2 limit 1")],
     "Curve 99"),
    (["{mesh}", *functions(LEFT), "--entity", "2,77"], "Surface 77"),
    (["{mesh}", *functions(LEFT), "--entity", "two"], "'two'"),
    (["{mesh}", *functions(LEFT), "--entity", "0,99"], "Point 99"),
    (["{mesh}", *functions(LEFT), "--entity", "2,2"], "No size function acts on Surface 2"),
    (["{mesh}", *functions(LEFT), "--calibrate"], "calibrate"),
    (["{mesh}", *functions("mesh source Surface{2} attach Surface{1} growth 1.2 limit 1"),
      "--strict"], "Surface 2 has no mesh"),
    (["{mesh}", "--nonsense"], "--nonsense"),
])
def test_what_is_wrong_is_told_and_gmsh_does_not_wait_for_ever(two_squares, arguments, words):
    """Gmsh waits for the answers of a server that has ended, so it must not end."""
    result = serve(points_around(4).tobytes() + END,
                   *(a.format(mesh=two_squares) if a == "{mesh}" else a for a in arguments))
    assert words in result.stderr.decode()
    assert result.returncode == (1 if "--strict" in arguments else 2)
    assert list(answers(result)) == [1e22] * 4


def test_source_without_a_mesh_is_told_on_standard_error_alone(two_squares):
    text = "mesh source Surface{2} attach Surface{1} growth 1.2 limit 1"
    result = serve(points_around(2).tobytes(), two_squares, *functions(text))
    assert b"Surface 2 has no mesh" in result.stderr
    assert list(answers(result)) == [1e22] * 2


# ==== Stock Gmsh

def run_gmsh(path, *arguments):
    folders = [os.path.dirname(os.path.abspath(PROGRAM)), os.path.dirname(GMSH)]
    environment = dict(os.environ, PATH=os.pathsep.join(folders + [os.environ["PATH"]]))
    environment.pop("PYTHONPATH", None)
    # From another folder than that of the model.
    result = subprocess.run([GMSH, "-", str(path), *arguments], cwd="/", env=environment,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            timeout=300)
    assert result.returncode == 0, result.stdout
    assert "Error" not in result.stdout, result.stdout
    return result.stdout


def report(path, dim, text):
    result = subprocess.run([PROGRAM, "report", path, "--dim", str(dim), "--json",
                             "--size-function", text], stdout=subprocess.PIPE, check=True)
    return json.loads(result.stdout)[0]["report"]


def example(name, tmp_path):
    return shutil.copy(os.path.join(EXAMPLES, name), tmp_path)


def test_stock_gmsh_grows_a_plate_from_a_curve(tmp_path):
    run_gmsh(example("stock_gmsh_serve.geo", tmp_path))
    grown = report(tmp_path / "stock_gmsh_serve.msh", 2,
                   "mesh source Curve{5} attach Surface{3} growth 1.2 limit 0.5")
    assert grown["elements"] > 1500
    assert grown["ratio_99"] < 1.35
    assert grown["length_share_over_2"] == 0
    assert grown["length_share_good"] > 0.95


def test_stock_gmsh_grows_volumes_from_a_surface(tmp_path):
    run_gmsh(example("stock_gmsh_serve_3d.geo", tmp_path))
    text = "mesh source Surface{7:12} attach Volume{2,3} growth 1.2 limit 1"
    grown = report(tmp_path / "stock_gmsh_serve_3d.msh", 3, text)
    # Without calibration, as Gmsh follows any field.
    assert grown["ratio_99"] < 1.4
    assert grown["length_share_over_2"] < 0.02
    assert 1.1 < grown["length_median"] < 1.4
    plain = (tmp_path / "stock_gmsh_serve_3d.geo")
    plain.write_text(plain.read_text().replace("Background Field = 2;", "Background Field = 0;"))
    run_gmsh(plain)
    without = report(tmp_path / "stock_gmsh_serve_3d.msh", 3, text)
    assert without["length_share_over_2"] > grown["length_share_over_2"] + 0.1


def test_stock_gmsh_ends_when_the_server_has_no_field(tmp_path):
    path = tmp_path / "wrong.geo"
    path.write_text('SetFactory("OpenCASCADE");\nRectangle(1) = {0, 0, 0, 1, 1};\n'
                    'Field[1] = ExternalProcess;\n'
                    'Field[1].CommandLine = "meshgrow serve lost.msh --defaults 1";\n'
                    'Background Field = 1;\n')
    assert "Cannot read lost.msh" in run_gmsh(path, "-2", "-o", str(tmp_path / "wrong.msh"))
