"""The air above a terrain: it grows from a discrete surface, which stays as it was measured."""

import os
import shutil

import gmsh
import numpy as np

import program
from example_fixture import EXAMPLES, example  # noqa: F401


def test_the_air_grows_from_the_terrain(example, tmp_path):
    rows = example("terrain").main()
    before, grown = rows["without"]["air"], rows["with"]["air"]
    assert grown["ratio_99"] <= 1.32
    assert before["ratio_99"] > grown["ratio_99"] + 0.1
    assert grown["length_share_over_2"] <= 0.03
    assert before["length_share_over_2"] > 0.3
    assert (tmp_path / "terrain.air.case.json").exists()


def test_the_terrain_is_the_measured_one_to_the_bit(example):
    module = example("terrain")
    places, (corners,) = module.main()["with"]["terrain"]
    gmsh.initialize()
    measured, triangles = module.read_triangles("terrain_stl_data.stl")
    gmsh.finalize()
    assert places == {node + 1: tuple(place) for node, place in enumerate(measured.tolist())}
    assert np.array_equal(corners, triangles.flatten() + 1)


def test_terrain_geo_gives_the_mesh_of_terrain_py(example, tmp_path):
    air = example("terrain").main()["with"]["air"]
    shutil.copy(os.path.join(EXAMPLES, "terrain.geo"), tmp_path)
    done = program.run("mesh", tmp_path / "terrain.geo", "-3", "-o", tmp_path / "geo.msh")
    assert done.returncode == 0, done.stderr
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.open(str(tmp_path / "geo.msh"))
    assert sum(map(len, gmsh.model.mesh.getElements(3)[1])) == air["elements"]
    gmsh.finalize()
