"""`meshgrow mesh` in the place of `gmsh`: the same arguments make the same mesh."""

import re
import subprocess
import sys

import gmsh
import pytest

from program import PROGRAM

# The program of the Gmsh that this Python has: both start with the library's own main function.
GMSH = (["/usr/bin/gmsh"] if gmsh.__version__.startswith("4.8") else
        [sys.executable, "-c", "import sys, gmsh; gmsh.initialize(sys.argv, run=True)"])

MODEL = """
SetFactory("OpenCASCADE");
DefineConstant[ radius = 0.3, h = 0.4 ];
Sphere(1) = {0, 0, 0, radius};
Box(2) = {-1, -1, -1, 2, 2, 2};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
MeshSize{ PointsOf{ Volume{:}; } } = h;
"""
PHYSICAL = """
Physical Volume("ball") = {1};
Physical Surface("its skin") = {1};
"""
PLATE = """
SetFactory("OpenCASCADE");
Disk(1) = {0, 0, 0, 1, 0.5};
Mesh.MeshSizeMax = 0.2;
"""
SETTINGS = MODEL + "Mesh.MeshSizeMax = 0.25; Mesh.ElementOrder = 2;\n"


def run(command, arguments, directory):
    return subprocess.run([*command, *map(str, arguments)], capture_output=True, text=True,
                          cwd=directory)


@pytest.fixture
def directory(tmp_path):
    for name, text in {"model.geo": MODEL, "physical.geo": MODEL + PHYSICAL, "plate.geo": PLATE,
                       "settings.geo": SETTINGS, "size.opt": "Mesh.MeshSizeMax = 0.3;\n",
                       "part.geo": "SetFactory(\"OpenCASCADE\"); Box(9) = {2, 0, 0, 1, 1, 1};\n",
                       "self.geo": MODEL + 'Mesh 2; Save "self_made.msh";\n',
                       "vtk.geo": PLATE + "Mesh.Format = 16;\n"}.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def files_of(directory):
    return {path.name: path.read_bytes() for path in directory.iterdir()
            if path.suffix not in (".geo", ".opt", "")}


def counts(path):
    """Numbers of nodes, and of elements by type, and the physical groups of a mesh file."""
    gmsh.clear()
    gmsh.open(str(path))
    nodes = len(gmsh.model.mesh.getNodes()[0])
    types, tags, _ = gmsh.model.mesh.getElements()
    return nodes, {t: len(n) for t, n in zip(types, tags)}, gmsh.model.getPhysicalGroups()


SAME = [
    "model.geo -3 -o out.msh",
    "-3 model.geo -o out.msh",
    "-o out.msh -clmax 0.3 model.geo -3",
    "model.geo -3 -clmax 0.3 -clmin 0.1 -o out.msh",
    "model.geo -3 -clscale 0.6 -o out.msh",
    "model.geo -2 -clcurv 20 -o out.msh",
    "model.geo -3 -clextend 0 -clmax 0.5 -o out.msh",
    "model.geo -1",
    "model.geo -3 -2",
    "model.geo -2 -algo del2d -o out.msh",
    "model.geo -2 -algo meshadapt -o out.msh",
    "plate.geo -2 -quad -o out.msh",
    "plate.geo -2 -smooth 5 -o out.msh",
    "plate.geo -2 -rand 1e-3 -o out.msh",
    "model.geo -3 -order 2 -o out.msh",
    "plate.geo -2 -order 3 -optimize_ho -o out.msh",
    "model.geo -3 -optimize -o out.msh",
    "model.geo -3 -optimize_threshold 0.6 -o out.msh",
    "model.geo -3 -format msh2",
    "model.geo -3 -format msh2 -o out.msh",
    "model.geo -2 -format vtk",
    "model.geo -2 -format stl -o out.dat",
    "model.geo -3 -format unv",
    "model.geo -3 -f inp",
    "model.geo -3 -bin -o out.msh",
    "model.geo -3 -vmsh 2.2 -o out.msh",
    "model.geo -3 -o out.su2",
    "vtk.geo -2",
    "vtk.geo -2 -o out.txt",
    "physical.geo -3",
    "physical.geo -3 -save_all",
    "physical.geo -3 -saveall -format msh22",
    "model.geo -3 -save_parametric -o out.msh",
    "model.geo -3 -setnumber radius 0.5 -setnumber Mesh.MeshSizeMax 0.3 -o out.msh",
    "model.geo -3 -setnumber h 0.2",
    ["model.geo", "-3", "-string", "Mesh.MeshSizeMax = 0.2;"],
    "model.geo -3 -option size.opt",
    "model.geo part.geo -3",
    "model.geo -merge part.geo -3 -o out.msh",
    "settings.geo -3 -clmax 0.1 -order 1 -o out.msh",
    "model.geo -save",
    "self.geo -",
    "model.geo -",
    "plate.geo -2 -v 0 -nopopup",
    "model.geo -3 -part 3 -o out.msh",
]
if not gmsh.__version__.startswith("4.8"):
    # Debian's Gmsh is built without Netgen, its HXT makes another mesh each time, and its Frontal
    # for quads crashes.
    SAME += ["part.geo -2 -algo delquad -clmax 0.3 -o out.msh",
             "model.geo -3 -algo front3d -o out.msh", "model.geo -3 -algo hxt -nt 1 -o out.msh",
             "model.geo -3 -optimize_netgen -o out.msh"]


def counts_of(directory, name, content):
    path = directory / "compared" / name
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(content)
    return counts(path)


@pytest.mark.parametrize("line", SAME, ids=lambda a: a if isinstance(a, str) else " ".join(a))
def test_same_mesh_as_gmsh(directory, line):
    arguments = line.split() if isinstance(line, str) else line
    gmsh_run = run(GMSH, arguments, directory)
    expected = files_of(directory)
    for name in expected:
        (directory / name).unlink()
    result = run([PROGRAM, "mesh"], arguments, directory)
    assert result.returncode == 0, result.stderr
    made = files_of(directory)
    assert sorted(made) == sorted(expected), gmsh_run.stdout
    assert (expected != {}) == (line != "model.geo -")
    for name, content in expected.items():
        # Some formats hold the name that the file had while it was written.
        own = re.sub(rb"\.(\w+)\.unfinished", rb"\1", made[name])
        assert own == content or counts_of(directory, name, own) == counts_of(
            directory, name, content), result.stdout


@pytest.mark.parametrize("line, words", [
    ("model.geo -xyz", ["-xyz", "--help"]),
    ("-refine model.geo", ["-refine", "other work"]),
    ("model.geo -0", ["-0"]),
    ("model.geo -3 -bgm sizes.pos", ["-bgm", "PostView"]),
    ("model.geo -part 2 -part_split", ["-part_split", "more than one file"]),
    ("model.geo -3 -theme dark", ["-theme", "window"]),
    ("model.geo -clmax", ["-clmax", "value"]),
    ("model.geo -setnumber h", ["-setnumber", "values"]),
    ("model.geo -setlist l 3 1 2", ["-setlist", "values"]),
    ("model.geo -algo best", ["Unknown mesh algorithm"]),
    ("model.geo -clmax 0", ["must be > 0"]),
    ("model.geo -format best", ["best"]),
    ("missing.geo -3", ["missing.geo"]),
    ("model.geo missing.step -3", ["missing.step"]),
    ("model.geo -3 -format png", ["Mesh.Format", "holds no mesh"]),
])
def test_what_is_not_taken_is_named(directory, line, words):
    before = sorted(p.name for p in directory.iterdir())
    result = run([PROGRAM, "mesh"], line.split(), directory)
    assert result.returncode == 2
    told = [text for text in result.stderr.splitlines() if text.startswith("meshgrow: ")]
    assert len(told) == 1 and all(word in told[0] for word in words), result.stderr
    assert sorted(p.name for p in directory.iterdir()) == before


def test_values_of_own_options_are_not_mistaken_for_options_of_gmsh(directory):
    result = run([PROGRAM, "mesh"], ["model.geo", "--tolerance", "-1"], directory)
    assert result.returncode == 2 and "tolerance" in result.stderr
    result = run([PROGRAM, "mesh"], ["model.geo", "-2", "--size-function",
                                     "fixed source Surface{1} attach Surface{1} size 0.1 "
                                     "growth 1.2 limit 1", "-clmax", "0.15"], directory)
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize("line", ["-order 2 -format msh2", "-format vtk -nt 2",
                                  "-optimize -order 2 -optimize_ho", "-algo hxt -clscale 0.5"])
def test_gmsh_options_act_beside_size_functions(directory, line):
    """Order, format and size factor are as with gmsh, though other sizes rule."""
    sizes = ["--size-function", "fixed source Surface{1} attach Volume{:} size 0.15 growth 1.3 "
                                "limit 0.5"]
    result = run([PROGRAM, "mesh"], ["model.geo", "-3", *line.split(), *sizes], directory)
    assert result.returncode == 0, result.stderr
    name, = files_of(directory)
    assert name == ("model.vtk" if "vtk" in line else "model.msh")
    nodes, types, _ = counts(directory / name)
    assert (11 if "-order 2" in line else 4) in types
    if "msh2" in line:
        assert files_of(directory)[name].startswith(b"$MeshFormat\n2.2 ")


@pytest.mark.parametrize("extra", [[], ["-optimize_ho"]])
def test_high_order_elements_beside_size_functions_are_optimized_on_request(directory, extra):
    sizes = ["--size-function", "fixed source Curve{1} attach Surface{1} size 0.5 growth 1.3 "
                                "limit 0.5"]
    result = run([PROGRAM, "mesh"], ["plate.geo", "-2", "-order", "3", "-v", "5", *extra, *sizes],
                 directory)
    assert result.returncode == 0, result.stderr
    assert ("Done optimizing high-order mesh" in result.stdout) == bool(extra)
