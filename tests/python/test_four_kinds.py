"""All four kinds together, defaults, and their texts, through Gmsh."""

import os
import re
import subprocess

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from meshes import assert_conforming, boundary, everything_in_the_model, premesh, snapshots
from reference import curvature_size, gap_size

PROGRAM = os.environ["MESHGROW_PROGRAM"]


def ball_near_a_wall():
    """A ball in a box, 0.3 from the wall z = -2."""
    models.start("ball near a wall")
    occ = gmsh.model.occ
    box, ball = occ.addBox(-2, -2, -2, 4, 4, 4), occ.addSphere(0, 0, -0.7, 1)
    occ.fragment([(3, box)], [(3, ball)])
    occ.synchronize()
    inner, outer = sorted(gmsh.model.getEntities(3), key=lambda v: occ.getMass(*v))
    face = models.faces_of(inner[1])[0]
    return inner, outer, face


def add_all(field, inner, outer, face):
    """Each with its own growth and limit."""
    point = next(p for p in boundary(boundary(boundary([outer])))
                 if gmsh.model.getValue(*p, []).max() == 2 == gmsh.model.getValue(*p, []).min())
    field.add_mesh([face], [outer], growth_rate=1.2, size_limit=0.6)
    field.add_fixed([point], [outer], size=0.08, growth_rate=1.5, size_limit=0.7)
    field.add_curvature([inner], [outer], angle=10, growth_rate=1.1, size_limit=0.5)
    field.add_proximity([outer], [outer], 3, growth_rate=1.3, size_limit=0.8)
    return field


def test_smallest_of_four_kinds_rules():
    inner, outer, face = ball_near_a_wall()
    premesh([face], lambda x, y, z: 0.12 + 0.1 * (z + 1.7))
    together = add_all(meshgrow.SizeField(evaluator="exact"), inner, outer, face)
    texts = [function["text"] for function in together.statistics()["functions"]]
    assert [text.split()[0] for text in texts] == ["mesh", "fixed", "curvature", "proximity"]
    alone = []
    for text in texts:
        alone.append(meshgrow.SizeField(evaluator="exact"))
        alone[-1].add(text)
    points = np.random.default_rng(4).uniform(-2, 2, (4000, 3))
    sizes = np.array([field.exact_size(*outer, points) for field in alone])
    np.testing.assert_array_equal(together.exact_size(*outer, points), sizes.min(axis=0))
    assert set(sizes.argmin(axis=0)) == {0, 1, 2, 3}, "each kind should rule somewhere"
    on_grid = meshgrow.SizeField()
    for text in texts:
        on_grid.add(text)
    assert (on_grid.size(*outer, points) <= 1.05 * sizes.min(axis=0)).all()


def test_one_grid_for_each_set_of_functions():
    inner, outer, face = ball_near_a_wall()
    premesh([face], 0.2)
    field = add_all(meshgrow.SizeField(evaluator="grid"), inner, outer, face)
    field.refresh()
    groups = field.statistics()["groups"]
    assert [g["functions"] for g in groups if g["grid"]] == [[0, 1, 2, 3]]
    assert not any(g["entities"] == [list(inner)] for g in groups)
    field.add_curvature([inner], [inner], size_limit=1)
    field.refresh()
    # The ball alone, the rest alone, and their common face with both.
    assert sorted(g["functions"] for g in field.statistics()["groups"] if g["grid"]) == [
        [0, 1, 2, 3], [0, 1, 2, 3, 4], [4]]


def test_generate_with_all_four_keeps_what_was_meshed():
    inner, outer, face = ball_near_a_wall()
    premesh([face], lambda x, y, z: 0.15 + 0.1 * (z + 1.7))
    before = snapshots([face])
    add_all(meshgrow.SizeField(), inner, outer, face).generate(3)
    assert snapshots([face]) == before
    assert_conforming(outer, inner)
    report = meshgrow.report(3, [outer])
    assert report["ratio_99"] < 1.4


# ==== Defaults


def test_defaults_are_curvature_and_proximity_of_everything():
    volume = models.single(lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 0.2, 3))
    field = meshgrow.SizeField(evaluator="exact")
    field.create_defaults(size_limit=5)
    functions = field.statistics()["functions"]
    assert [f["text"] for f in functions] == [
        "curvature source Volume{1} attach Volume{1} angle 18 growth 1.2 limit 5",
        "proximity source Volume{1} attach Volume{1} cells 3 between both growth 1.2 limit 5"]
    np.testing.assert_allclose(field.exact_size(*volume, [[0, 0, 0], [1, 1, 0.2]]),
                               gap_size(0.2, 3, 1.2), rtol=0.01)


def test_defaults_of_named_entities():
    inner, outer, face = ball_near_a_wall()
    field = meshgrow.SizeField(evaluator="exact")
    field.create_defaults([inner], growth_rate=1.4, size_limit=5, min_size=0.25)
    assert np.isinf(field.exact_size(*outer, [[0, 0, 0]])[0])
    assert field.exact_size(*face, [[0, 0, 0.3]])[0] == pytest.approx(
        max(0.25, curvature_size(1, 18)), rel=0.02)
    texts = [f["text"] for f in field.statistics()["functions"]]
    assert all("growth 1.4" in text and "min 0.25" in text for text in texts)


def test_defaults_of_plane_models_and_of_curves_alone():
    square = models.square()
    field = meshgrow.SizeField(evaluator="exact")
    field.create_defaults(size_limit=2)
    assert field.exact_size(*square.face, [[0, 0.5, 0]])[0] == pytest.approx(
        gap_size(1, 3, 1.2), rel=0.01)
    alone = meshgrow.SizeField()
    alone.create_defaults([square.left], size_limit=2)
    assert [f["kind"] for f in alone.statistics()["functions"]] == ["curvature"]


def test_defaults_need_a_limit():
    models.box()
    with pytest.raises(ValueError, match="size_limit"):
        meshgrow.SizeField().create_defaults()


# ==== Text and program


def test_program_takes_all_kinds(tmp_path):
    geo = tmp_path / "plate.geo"
    geo.write_text('SetFactory("OpenCASCADE");\nBox(1) = {0,0,0, 4,4,1};\n'
                   'Cylinder(2) = {2,2,-1, 0,0,3, 1};\n'
                   "BooleanDifference{Volume{1}; Delete;}{Volume{2}; Delete;}\n")
    run = subprocess.run(
        [PROGRAM, "mesh", str(geo), "-3", "-o", str(tmp_path / "plate.msh"),
         "--size-function", "curvature source Volume{1} attach Volume{1} growth 1.3 limit 1",
         "--size-function",
         "proximity source Volume{1} attach Volume{1} cells 2 between faces growth 1.3 limit 1"],
        capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert re.search("Curvature size function 1 +Volume 1 ", run.stdout)
    assert "2 cells per gap" in run.stdout
    assert (tmp_path / "plate.msh").exists()


def test_program_has_defaults(tmp_path):
    geo = tmp_path / "box.geo"
    geo.write_text('SetFactory("OpenCASCADE");\nBox(1) = {0,0,0, 4,4,1};\n')
    run = subprocess.run([PROGRAM, "mesh", str(geo), "-3", "--defaults", "0.9", "-o",
                          str(tmp_path / "box.msh")], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert "Curvature size function 1" in run.stdout
    assert re.search(r"Proximity size function 2 .* 0\.9 ", run.stdout)


def test_mistake_in_a_text_is_told_with_its_position():
    models.box()
    with pytest.raises(meshgrow.Error, match="'faces', 'edges' or 'both' at position 61"):
        meshgrow.SizeField().add(
            "proximity source Volume{1} attach Volume{1} cells 3 between walls growth 1.2 limit 2")


def test_reading_and_summing_up_changes_nothing():
    inner, outer, face = ball_near_a_wall()
    premesh([face], 0.3)
    before = everything_in_the_model()
    field = meshgrow.SizeField()
    field.create_defaults(size_limit=2)
    assert "facets" in field.summary()
    field.size(*outer, [[1, 1, 1]])
    field.register()
    field.unregister()
    assert everything_in_the_model() == before
