"""Calibrated sizes: Gmsh's edges get the length asked for; meshers that ignore sizes are told."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from meshes import Log, element_count, options, premesh

ALGORITHMS = pytest.mark.parametrize("algorithm", [1, 10], ids=["Delaunay", "HXT"])


def sphere_in_box(algorithm, calibrate):
    """A box around a sphere premeshed from 0.08 to 0.25; report of the box."""
    model = models.sphere_in_box(4.0)
    premesh([model.sphere], lambda x, y, z: 0.08 + 0.085 * (z + 1))
    field = meshgrow.SizeField(calibrate=calibrate)
    field.add_mesh([model.sphere], [model.outer], 1.2, 1.0)
    with options(Mesh_Algorithm3D=algorithm):
        field.generate(3)
    return meshgrow.report(3, [model.outer], field)


@ALGORITHMS
def test_calibrated_volumes_have_edges_of_the_length_asked_for(algorithm):
    plain = sphere_in_box(algorithm, False)
    assert plain["length_median"] > 1.15 and plain["length_share_good"] < 0.75
    calibrated = sphere_in_box(algorithm, True)
    print(algorithm, plain["length_median"], calibrated["length_median"],
          calibrated["length_share_good"])
    assert 0.95 < calibrated["length_median"] < 1.05
    assert calibrated["length_share_good"] > 0.94
    assert calibrated["ratio_99"] <= plain["ratio_99"]


@pytest.mark.parametrize("algorithm", [1, 5, 6])
def test_calibrated_surfaces_have_edges_of_the_length_asked_for(algorithm):
    model = models.square(4.0)
    premesh([model.left], 0.05)
    field = meshgrow.SizeField(calibrate=True)
    field.add_mesh([model.left], [model.face], 1.2, 2.0)
    with options(Mesh_Algorithm=algorithm):
        field.generate(2)
    report = meshgrow.report(2, [model.face], field)
    assert 0.95 < report["length_median"] < 1.05 and report["length_share_good"] > 0.94


def test_calibration_changes_what_gmsh_is_told_but_not_what_is_asked_for():
    model = models.sphere_in_box(4.0)
    premesh([model.sphere], 0.2)
    sizes = []
    points = np.random.default_rng(3).uniform(-2, 2, (100, 3))
    for calibrate in (False, True):
        field = meshgrow.SizeField(calibrate=calibrate)
        field.add_mesh([model.sphere], [model.outer], 1.2, 1.0)
        sizes.append(field.size(*model.outer, points))
    assert (sizes[0] == sizes[1]).all()


def test_a_registered_field_is_calibrated_too():
    counts = []
    for calibrate in (False, True):
        model = models.box()
        field = meshgrow.SizeField(calibrate=calibrate)
        field.add_fixed([model], [model], 0.12, 1.2, 0.12)
        field.register()
        gmsh.model.mesh.generate(3)
        counts.append(element_count(model))
        field.unregister()
    assert counts[1] > 1.5 * counts[0]


@pytest.mark.parametrize("option, value, dim, name", [
    ("Mesh_Algorithm", 7, 2, "BAMG"), ("Mesh_Algorithm3D", 4, 3, "Frontal")])
def test_meshers_that_ask_for_no_sizes_are_warned_of(option, value, dim, name):
    model = models.box()
    premesh([(2, 1)], 0.3)
    field = meshgrow.SizeField()
    field.add_mesh([(2, 1)], [model], 1.2, 0.5)
    with Log() as log, options(**{option: value}):
        field.register()  # meshing itself may fail: Debian's Gmsh has no 3D Frontal
        field.unregister()
    assert len([w for w in log.warnings if name in w]) == 1
    with Log() as log:
        field.register()
        field.unregister()
    assert not [w for w in log.warnings if "asks for" in w]
