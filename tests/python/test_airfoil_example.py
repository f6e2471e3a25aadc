"""The airfoils of Figure 1: by six fixed size functions and by one mesh size function."""

import os
import subprocess

import gmsh
import pytest

import program
from example_fixture import EXAMPLES, example  # noqa: F401

# Variant of naca0012 in airfoil.py -> what .geo and .cpp are told.
TOLD = {
    ("naca0012", "with"): ([], []),
    ("naca0012", "fixed"): (["-setnumber", "six_fixed", "1"], ["six_fixed"]),
    ("naca0012_quads", "with"): (["-setnumber", "quads", "1"], ["quads"]),
}


@pytest.fixture
def rows(example):  # noqa: F811
    return example("airfoil").main()


def elements_in(path):
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.open(str(path))
    count = sum(map(len, gmsh.model.mesh.getElements(2)[1]))
    gmsh.finalize()
    return count


def test_the_air_grows_from_the_bunched_curves(rows, tmp_path):
    for name in ("naca0012", "cambered_flap"):
        before, grown = rows[name, "without"], rows[name, "with"]
        assert grown["ratio_99"] <= 1.3
        assert before["ratio_99"] > grown["ratio_99"] + 0.1
        assert grown["length_share_over_2"] <= 0.001 and before["length_share_over_2"] > 0.05
        assert grown["length_share_good"] > 0.95
        assert grown["gamma_min"] > 0.6
        assert (tmp_path / ("airfoil.%s.case.json" % name)).exists()


def test_quadrilaterals_grow_from_the_bunched_curves(rows):
    before, grown = rows["naca0012_quads", "without"], rows["naca0012_quads", "with"]
    assert grown["quads"] > 0.98
    assert before["ratio_99"] > grown["ratio_99"] + 0.1
    assert grown["length_share_over_2"] <= 0.001 and before["length_share_over_2"] > 0.04


def test_one_mesh_function_gives_what_takes_six_fixed_ones(rows):
    fixed, grown = rows["naca0012", "fixed"], rows["naca0012", "with"]
    assert grown["input"] == 5 and fixed["input"] == 14
    for place in ("nose", "shock", "tail"):
        assert grown[place] == pytest.approx(0.0074, rel=0.03)
        assert fixed[place] == pytest.approx(grown[place], rel=0.25)
    # No edge of the airfoil asks its neighbour to be smaller than it is.
    assert grown["along"] <= 1.2
    assert grown["ratio_99"] <= fixed["ratio_99"]


def test_geo_gives_the_mesh_of_the_python_example(rows, tmp_path):
    for variant, (options, _) in TOLD.items():
        path = tmp_path / "geo.msh"
        model = os.path.join(EXAMPLES, "airfoil.geo")
        done = program.run("mesh", model, "-2", "-o", path, *options)
        assert done.returncode == 0, done.stderr
        assert elements_in(path) == rows[variant]["elements"]


def test_cpp_gives_the_mesh_of_the_python_example(rows, tmp_path):
    generation = "debian" if gmsh.GMSH_API_VERSION.startswith("4.8") else "newest"
    built = os.path.join(os.path.dirname(program.PROGRAM), "examples", "airfoil_" + generation)
    if not os.path.exists(built):
        pytest.skip("%s is not built" % built)
    for variant, (_, words) in TOLD.items():
        path = tmp_path / "cpp.msh"
        subprocess.run([built, str(path), *words], check=True, stdout=subprocess.DEVNULL)
        assert elements_in(path) == rows[variant]["elements"]
