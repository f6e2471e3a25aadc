"""The crack in a block: the volume grows from an embedded surface, which stays as it is."""

import os
import subprocess

import gmsh
import pytest

import program
from example_fixture import EXAMPLES, example  # noqa: F401


def test_a_block_grows_from_the_crack_embedded_in_it(example, tmp_path):
    rows = example("crack").main()
    before, grown = rows["without"]["block"], rows["with"]["block"]
    assert grown["ratio_99"] <= 1.3
    assert before["ratio_99"] > grown["ratio_99"] + 0.1
    assert grown["length_share_over_2"] <= 0.01
    assert before["length_share_over_2"] > 0.4
    assert (tmp_path / "crack.block.case.json").exists()


def test_the_crack_keeps_its_mesh_to_the_bit(example):
    for row in example("crack").main().values():
        places, elements = row["premesh"]
        assert len(places) > 100 and elements
        assert row["crack"] == row["premesh"]


def elements_of(path):
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.open(str(path))
    counted = sum(map(len, gmsh.model.mesh.getElements(3)[1]))
    gmsh.finalize()
    return counted


def test_crack_geo_gives_the_mesh_of_crack_py(example, tmp_path):
    block = example("crack").main()["with"]["block"]
    done = program.run("mesh", os.path.join(EXAMPLES, "crack.geo"), "-3", "-o",
                       tmp_path / "geo.msh", "-setnumber", "coarse", "2")
    assert done.returncode == 0, done.stderr
    assert elements_of(tmp_path / "geo.msh") == block["elements"]


def test_crack_cpp_gives_the_mesh_of_crack_py(example, tmp_path):
    built = os.path.join(os.path.dirname(program.PROGRAM), "examples", "crack")
    linked = "libgmsh.so." + ".".join(gmsh.GMSH_API_VERSION.split(".")[:2])
    if not os.path.exists(built) or linked not in subprocess.run(
            ["ldd", built], capture_output=True, text=True, check=True).stdout:
        pytest.skip("%s is not built with this Gmsh" % built)
    block = example("crack").main()["with"]["block"]
    subprocess.run([built, str(tmp_path / "cpp.msh")], check=True, stdout=subprocess.DEVNULL)
    assert elements_of(tmp_path / "cpp.msh") == block["elements"]
