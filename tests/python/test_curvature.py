"""Curvature size functions. (Facets against closed forms: tests/plugin/source_facets_test.cpp.)"""

import math

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from meshes import (corner_tags, corners, everything_in_the_model, node_positions, premesh,
                    snapshots)
from reference import curvature_size

ANGLE = 18.0
LIMIT = 50.0


def curvature_field(sources, attach, growth_rate=1.2, size_limit=LIMIT, angle=ANGLE, **how):
    field = meshgrow.SizeField(evaluator="exact")
    field.add_curvature(sources, attach, angle, growth_rate, size_limit, **how)
    return field


def curved_face(volume, kind):
    return next(f for f in models.faces_of(volume[1]) if gmsh.model.getType(*f) == kind)


# ==== From CAD


@pytest.mark.parametrize("angle", [6.0, 18.0, 30.0])
def test_sphere_has_the_chord_of_the_angle(angle):
    volume = models.single(lambda occ: occ.addSphere(1, 2, 3, 2))
    field = curvature_field([volume], [volume], angle=angle)
    points = np.array([[1, 2, 5], [3, 2, 3], [1, 0, 3], [-1, 2, 3]])
    np.testing.assert_allclose(field.exact_size(*volume, points), curvature_size(0.5, angle),
                               rtol=0.02)
    centre = field.exact_size(*volume, [[1, 2, 3]])[0]
    assert centre == pytest.approx(curvature_size(0.5, angle) + 2 / 6, rel=0.01)


def test_volume_stands_for_its_faces_and_flat_ones_ask_for_nothing():
    volume = models.single(lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 9, 0.5))
    whole = curvature_field([volume], [volume])
    side = curvature_field([curved_face(volume, "Cylinder")], [volume])
    points = np.random.default_rng(1).uniform(-0.5, 9, (50, 3))
    np.testing.assert_array_equal(whole.exact_size(*volume, points),
                                  side.exact_size(*volume, points))
    flat = curvature_field([curved_face(volume, "Plane")], [volume], size_limit=1.5)
    np.testing.assert_array_equal(flat.exact_size(*volume, points), 1.5)
    assert flat.statistics()["functions"][0]["effective"]


def test_smallest_size_bounds_the_tip_of_a_cone():
    volume = models.single(lambda occ: occ.addCone(0, 0, 0, 0, 0, 3, 1, 0))
    tip = np.array([[0.0, 0.0, 3.0]])
    free = curvature_field([volume], [volume]).exact_size(*volume, tip)[0]
    bounded = curvature_field([volume], [volume], min_size=0.1).exact_size(*volume, tip)[0]
    assert 0 < free < 0.02
    assert bounded == pytest.approx(0.1)


def test_surface_stands_for_its_curves_in_a_plane_model():
    models.start("disc")
    gmsh.model.occ.addDisk(0, 0, 0, 2, 1)
    gmsh.model.occ.synchronize()
    field = curvature_field([(2, 1)], [(2, 1)], growth_rate=1e6)
    # Radii of curvature of the ellipse at its vertices: b²/a and a²/b.
    np.testing.assert_allclose(field.exact_size(2, 1, [[2, 0, 0], [0, 1, 0]]),
                               [curvature_size(2, ANGLE), curvature_size(0.25, ANGLE)], rtol=0.03)


def test_arcs_of_the_built_in_kernel():
    models.start("arc")
    geo = gmsh.model.geo
    centre, a, b = geo.addPoint(0, 0, 0), geo.addPoint(3, 0, 0), geo.addPoint(0, 3, 0)
    loop = geo.addCurveLoop([geo.addCircleArc(a, centre, b), geo.addLine(b, centre),
                             geo.addLine(centre, a)])
    face = geo.addPlaneSurface([loop])
    geo.synchronize()
    field = curvature_field([(2, face)], [(2, face)])
    middle = 3 * math.cos(math.pi / 4)
    np.testing.assert_allclose(
        field.exact_size(2, face, [[3, 0, 0], [middle, middle, 0], [0, 3, 0]]),
        curvature_size(1 / 3, ANGLE), rtol=0.02)


def test_nothing_in_the_model_changes():
    model = models.box_in_box_of(lambda occ: occ.addTorus(0, 0, 0, 1, 0.4))
    gmsh.model.addPhysicalGroup(3, [model.volume[1]])
    premesh(model.walls[:2], 1.0)
    gmsh.model.setVisibility(model.walls[:1], 0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.7)
    before = everything_in_the_model()
    field = curvature_field(models.faces_of(model.volume[1]), [model.volume])
    field.add_proximity([model.volume], [model.volume], size_limit=2, between="both")
    field.refresh()
    assert len(field.statistics()["functions"]) == 2
    assert everything_in_the_model() == before


def test_pole_of_a_spherical_shell_has_no_curvature_of_its_own():
    """In a model without volumes a surface stands for its curves as well, also those of no length."""
    models.start("shell")
    gmsh.model.occ.addSphere(0, 0, 0, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.occ.remove([(3, 1)])
    gmsh.model.occ.synchronize()
    field = curvature_field([(2, 1)], [(2, 1)], size_limit=0.4)
    np.testing.assert_allclose(field.exact_size(2, 1, [[0, 0, 1], [0, 0, -1], [1, 0, 0]]),
                               curvature_size(1, ANGLE), rtol=0.02)


# ==== From a mesh of the geometry


@pytest.mark.parametrize("size", [0.15, 0.6])
def test_mesh_on_the_source_is_used_with_the_curvature_of_the_geometry(size):
    volume = models.single(lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 3, 1))
    side = curved_face(volume, "Cylinder")
    premesh([side], size)
    field = curvature_field([side], [volume], growth_rate=1e6)
    centres = corners(side, "Triangle").mean(axis=1)
    assert field.statistics()["functions"][0]["effective"]
    assert field.statistics()["groups"][0]["facets"] == len(centres)
    # Also beside the seam, where the parameters of the nodes jump.
    np.testing.assert_allclose(field.exact_size(*volume, centres), curvature_size(1, ANGLE),
                               rtol=0.02)


def test_quads_on_the_source():
    volume = models.single(lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 3, 1))
    side = curved_face(volume, "Cylinder")
    gmsh.model.mesh.setRecombine(*side)
    premesh([side], 0.4)
    assert len(corners(side, "Quadrilateral")) > 50
    field = curvature_field([side], [volume])
    centres = corners(side, "Quadrilateral").mean(axis=1)
    np.testing.assert_allclose(field.exact_size(*volume, centres), curvature_size(1, ANGLE),
                               rtol=0.02)


def test_generate_makes_the_turn_that_was_asked_for():
    volume = models.single(lambda occ: occ.addSphere(0, 0, 0, 1))
    field = meshgrow.SizeField()
    field.add_curvature([volume], [volume], angle=15, growth_rate=1.2, size_limit=1)
    field.generate(2)
    corner = corners((2, 1), "Triangle")
    chords = np.concatenate([np.linalg.norm(corner[:, i] - corner[:, i - 1], axis=1)
                             for i in range(3)])
    turn = np.degrees(2 * np.arcsin(chords / 2))
    assert np.median(turn) == pytest.approx(15, rel=0.1)
    assert np.quantile(turn, 0.99) < 1.45 * 15


# ==== From an STL


def discrete_surface(points, triangles):
    """A discrete surface, as read from an STL file, in a model of its own."""
    models.start("discrete")
    gmsh.model.addDiscreteEntity(2, 1)
    gmsh.model.mesh.addNodes(2, 1, range(1, len(points) + 1), np.ravel(points))
    gmsh.model.mesh.addElementsByType(1, 2, [], np.ravel(triangles) + 1)
    gmsh.model.geo.addSurfaceLoop([1], 1)
    gmsh.model.geo.addVolume([1], 1)
    gmsh.model.geo.synchronize()
    return (2, 1), (3, 1)


def stl_of(make, size):
    """The mesh of the faces of an OpenCASCADE volume as one discrete surface."""
    volume = models.single(make)
    premesh(models.faces_of(volume[1]), size)
    positions = node_positions()
    triangles = np.concatenate([corner_tags(f, "Triangle") for f in models.faces_of(volume[1])])
    used, triangles = np.unique(triangles, return_inverse=True)
    return discrete_surface(positions[used], triangles.reshape(-1, 3))


@pytest.mark.parametrize("around", [24, 60])
def test_stl_of_a_cylinder_is_round_and_its_rims_are_sharp(around):
    phi = 2 * np.pi * np.arange(around) / around
    ring = np.column_stack((2 * np.cos(phi), 2 * np.sin(phi)))
    points = [[x, y, z] for z in (0, 5) for x, y in ring] + [[0, 0, 0], [0, 0, 5]]
    triangles = []
    for i in range(around):
        j = (i + 1) % around
        triangles += [[i, j, around + j], [i, around + j, around + i],
                      [j, i, 2 * around], [around + i, around + j, 2 * around + 1]]
    surface, volume = discrete_surface(points, triangles)
    field = curvature_field([surface], [volume], growth_rate=1e6)
    on_side = np.column_stack((ring * 0.9999, np.linspace(0.1, 4.9, around)))
    np.testing.assert_allclose(field.exact_size(*volume, on_side), curvature_size(0.5, ANGLE),
                               rtol=0.1)
    # Away from the sides, in the caps, nothing is curved: growth 1 / 1 from the rim.
    assert field.exact_size(*volume, [[0, 0, 0]])[0] == pytest.approx(
        curvature_size(0.5, ANGLE) + 2, rel=0.02)


def test_stl_of_a_sphere():
    surface, volume = stl_of(lambda occ: occ.addSphere(0, 0, 0, 2), 0.4)
    field = curvature_field([surface], [volume], growth_rate=1e6)
    centres = corners(surface, "Triangle").mean(axis=1)
    sizes = field.exact_size(*volume, centres)
    np.testing.assert_allclose(sizes, curvature_size(0.5, ANGLE), rtol=0.1)


def test_stl_of_a_box_has_no_curvature():
    surface, volume = stl_of(lambda occ: occ.addBox(0, 0, 0, 1, 1, 1), 0.2)
    before = snapshots([surface])
    field = curvature_field([surface], [volume], size_limit=3)
    assert field.statistics()["groups"][0]["facets"] == 0
    np.testing.assert_array_equal(field.exact_size(*volume, [[0.5, 0.5, 0.5], [0, 0, 0]]), 3.0)
    assert snapshots([surface]) == before


def test_discrete_curve():
    models.start("discrete circle")
    phi = np.linspace(0, 1.5 * np.pi, 40)
    points = np.column_stack((3 * np.cos(phi), 3 * np.sin(phi), 0 * phi))
    gmsh.model.addDiscreteEntity(0, 1)
    gmsh.model.addDiscreteEntity(0, 2)
    gmsh.model.addDiscreteEntity(1, 1, [1, 2])
    gmsh.model.mesh.addNodes(0, 1, [1], points[0])
    gmsh.model.mesh.addNodes(0, 2, [40], points[-1])
    gmsh.model.mesh.addNodes(1, 1, range(2, 40), points[1:-1].ravel())
    gmsh.model.mesh.addElementsByType(1, 1, [], np.ravel([[i, i + 1] for i in range(1, 40)]))
    field = curvature_field([(1, 1)], [(1, 1)])
    np.testing.assert_allclose(field.exact_size(1, 1, points), curvature_size(1 / 3, ANGLE),
                               rtol=0.01)


# ==== Bad input


@pytest.mark.parametrize("values, word", [
    ({"angle": 0}, "angle"), ({"angle": 400}, "angle"), ({"min_size": -1}, "smallest size"),
    ({"min_size": 2 * LIMIT}, "smallest size"), ({"growth_rate": 0.5}, "growth rate"),
    ({"size_limit": -1}, "size limit")])
def test_bad_numbers_are_named(values, word):
    volume = models.box()
    with pytest.raises(meshgrow.Error, match="Curvature size function 1: .*" + word):
        curvature_field([volume], [volume], **values)


def test_points_are_no_sources():
    volume = models.box()
    with pytest.raises(meshgrow.Error, match="Point 1 cannot be its source"):
        curvature_field([(0, 1)], [volume])


def test_unknown_sources_are_named():
    volume = models.box()
    with pytest.raises(meshgrow.Error, match="Surface 99"):
        curvature_field([(2, 99)], [volume])
