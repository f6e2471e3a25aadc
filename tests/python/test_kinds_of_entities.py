"""Every kind of entity that Gmsh knows: premeshed it is kept to the bit, unmeshed it is meshed."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from kinds import grow, grow_fixed
from meshes import (CELL_FACES, FACE_SIDES, assert_conforming, assert_conforming_surfaces,
                    boundary, cells_of, closure, corner_tags, corners, count_sides, element_count,
                    has_elements, node_positions, options, premesh, signed_volumes, snapshots)


def edges_in(entity):
    """Edges of all triangles, quadrilaterals and tetrahedra of an entity."""
    tetrahedron = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
    return set(count_sides(entity, dict(FACE_SIDES, Tetrahedron=tetrahedron)))


def point_node(point):
    return int(gmsh.model.mesh.getNodes(*point)[0][0])


# ==== Embedded points, curves and surfaces ====


def box_with(make, dim):
    """A unit box in which an entity, made by `make(occ)`, is embedded."""
    models.start("box with embedded entity")
    occ = gmsh.model.occ
    box = occ.addBox(0, 0, 0, 1, 1, 1)
    tag = make(occ)
    occ.synchronize()
    gmsh.model.mesh.embed(dim, [tag], 3, box)
    return (3, box), (dim, tag)


def inner_line(occ):
    return occ.addLine(occ.addPoint(.3, .3, .3), occ.addPoint(.7, .6, .5))


def inner_rectangle(occ):
    return occ.addRectangle(.25, .25, .5, .5, .5)


def test_point_embedded_in_a_volume_is_a_node_of_it():
    volume, point = box_with(lambda occ: occ.addPoint(.4, .5, .45), 0)
    grow_fixed([point], [volume], 0.1)
    assert_conforming(volume)
    assert point_node(point) in corner_tags(volume, "Tetrahedron")


def test_premeshed_faces_of_a_volume_with_an_embedded_point_are_kept():
    volume, point = box_with(lambda occ: occ.addPoint(.4, .5, .45), 0)
    faces = models.faces_of(volume[1])[:2]
    premesh(faces, 0.2)
    before = snapshots(closure(faces) + [point])
    grow(faces, [volume])
    assert snapshots(before) == before
    assert_conforming(volume)
    assert point_node(point) in corner_tags(volume, "Tetrahedron")


@pytest.mark.parametrize("premeshed", [True, False])
@pytest.mark.parametrize("dim, make", [(1, inner_line), (2, inner_rectangle)],
                         ids=["curve", "surface"])
def test_entity_embedded_in_a_volume_is_in_its_mesh(dim, make, premeshed):
    volume, inside = box_with(make, dim)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.25)
    if premeshed:
        premesh([inside], lambda x, y, z: 0.06 + 0.1 * x)
    before = snapshots(closure([inside])) if premeshed else {}
    grow([inside], [volume])
    assert snapshots(before) == before
    assert_conforming(volume)
    if dim == 1:
        pieces, found = cells_of(inside, ["Line"]), edges_in(volume)
    else:
        pieces, found = cells_of(inside, ["Triangle"]), set(count_sides(volume, CELL_FACES))
    assert len(pieces) > 1
    assert set(pieces) <= found


def square_with(make, dim):
    model = models.square()
    tag = make(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.embed(dim, [tag], *model.face)
    return model.face, (dim, tag)


def line_in_square(occ):
    return occ.addLine(occ.addPoint(.3, .3, 0), occ.addPoint(.7, .6, 0))


def test_point_embedded_in_a_surface_is_a_node_of_it():
    face, point = square_with(lambda occ: occ.addPoint(.4, .5, 0), 0)
    grow_fixed([point], [face], 0.02, 2)
    assert_conforming_surfaces(face)
    assert point_node(point) in corner_tags(face, "Triangle")
    lengths = [np.linalg.norm(t - np.roll(t, 1, axis=0), axis=1).max()
               for t in corners(face, "Triangle") if np.allclose(t, (.4, .5, 0), atol=.03)]
    assert lengths and max(lengths) < 0.05


def test_premeshed_surface_with_an_embedded_point_and_curve_is_kept():
    volume = models.box()
    occ = gmsh.model.occ
    bottom = next(f for f in models.faces_of(volume[1]) if occ.getCenterOfMass(*f)[2] < 1e-6)
    point = (0, occ.addPoint(.2, .8, 0))
    line = (1, line_in_square(occ))
    occ.synchronize()
    for inside in (point, line):
        gmsh.model.mesh.embed(inside[0], [inside[1]], *bottom)
    premesh([line], 0.05)
    premesh([bottom], 0.15)
    before = snapshots(closure([bottom, line]) + [point])
    grow([bottom], [volume])
    assert snapshots(before) == before
    assert_conforming(volume)
    assert point_node(point) in corner_tags(bottom, "Triangle")
    assert set(cells_of(line, ["Line"])) <= edges_in(bottom)


@pytest.mark.parametrize("premeshed", [True, False])
def test_curve_embedded_in_a_surface_is_in_its_mesh(premeshed):
    face, line = square_with(line_in_square, 1)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.2)
    if premeshed:
        premesh([line], lambda x, y, z: 0.02 + 0.1 * (x - 0.3))
    before = snapshots(closure([line])) if premeshed else {}
    grow([line], [face], 2)
    assert snapshots(before) == before
    assert_conforming_surfaces(face)
    assert len(cells_of(line, ["Line"])) > 1
    assert set(cells_of(line, ["Line"])) <= edges_in(face)


# ==== Seams and curves of zero length ====

CLOSED = {
    "sphere": lambda occ: occ.addSphere(0, 0, 0, 1),
    "cylinder": lambda occ: occ.addCylinder(0, 0, -0.7, 0, 0, 1.4, 0.7),
    "torus": lambda occ: occ.addTorus(0, 0, 0, 1, 0.4),
    "cone": lambda occ: occ.addCone(0, 0, -0.7, 0, 0, 1.4, 0.8, 0),
    "half sphere": lambda occ: occ.addSphere(0, 0, 0, 1, angle1=0),
}


def curves_of_zero_length():
    return [c for c in gmsh.model.getEntities(1)
            if np.ptp(np.reshape(gmsh.model.getValue(*c, np.linspace(
                *np.ravel(gmsh.model.getParametrizationBounds(*c)), 5)), (-1, 3)), axis=0).max()
            < 1e-9]


def assert_closed_without_collapsed_triangles(volume):
    faces = models.faces_of(volume[1])
    assert_conforming(volume)
    assert_conforming_surfaces(*faces)
    sides = sum((count_sides(f, FACE_SIDES) for f in faces), type(count_sides(faces[0], {}))())
    assert set(sides.values()) == {2}
    for face in faces:
        a, b, c = np.moveaxis(corners(face, "Triangle"), 1, 0)
        assert np.linalg.norm(np.cross(b - a, c - a), axis=1).min() > 1e-8
    assert signed_volumes(volume).min() > 0


@pytest.mark.parametrize("premeshed", [True, False])
@pytest.mark.parametrize("shape", sorted(CLOSED))
def test_surfaces_with_seams_and_poles_are_closed(shape, premeshed):
    volume = models.single(CLOSED[shape])
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
    faces = models.faces_of(volume[1])
    if premeshed:
        premesh(faces, lambda x, y, z: 0.3 + 0.1 * z)
    before = snapshots(closure(faces)) if premeshed else {}
    grow(faces, [volume])
    assert snapshots(before) == before
    assert_closed_without_collapsed_triangles(volume)
    if shape in ("sphere", "cone", "half sphere"):
        assert curves_of_zero_length()
    assert not any(has_elements(c) for c in curves_of_zero_length())


@pytest.mark.parametrize("shape", ["sphere", "cylinder", "torus", "cone"])
def test_premeshed_seams_are_kept_and_meshed_from_both_sides(shape):
    volume = models.single(CLOSED[shape])
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
    seams = [c for c in gmsh.model.getEntities(1)
             if any(boundary([f]).count(c) == 2 for f in gmsh.model.getEntities(2))]
    premesh(seams, lambda x, y, z: 0.15 + 0.1 * z)
    before = snapshots(closure(seams))
    assert any(has_elements(c) for c in seams)
    grow(seams, [volume])
    assert snapshots(before) == before
    assert_closed_without_collapsed_triangles(volume)


# ==== Discrete entities and imported meshes ====


def box_faces_in(name, tmp_path, size=0.3):
    """A file of the triangles on a unit box."""
    volume = models.box()
    with options(Mesh_MeshSizeMax=size):
        gmsh.model.mesh.generate(2)
    gmsh.model.removeEntities([volume])  # a .msh file would bring it along, empty
    path = str(tmp_path / name)
    gmsh.write(path)
    gmsh.model.remove()
    return path


def volume_inside(surfaces):
    geo = gmsh.model.geo
    volume = geo.addVolume([geo.addSurfaceLoop([tag for _, tag in surfaces])])
    geo.synchronize()
    return (3, volume)


def box_around(surfaces, low=-1.0, high=2.0):
    """A box of Gmsh's own kernel with a hole that these surfaces bound."""
    geo = gmsh.model.geo
    points = [geo.addPoint(x, y, low) for x, y in ((low, low), (high, low), (high, high),
                                                   (low, high))]
    lines = [geo.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
    bottom = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    extruded = geo.extrude([(2, bottom)], 0, 0, high - low)
    geo.remove([e for e in extruded if e[0] == 3])
    outside = geo.addSurfaceLoop([bottom] + [tag for dim, tag in extruded if dim == 2])
    volume = geo.addVolume([outside, geo.addSurfaceLoop([tag for _, tag in surfaces])])
    geo.synchronize()
    return (3, volume)


@pytest.mark.parametrize("around", [False, True], ids=["inside", "around"])
@pytest.mark.parametrize("name", ["box.stl", "box.msh", "box.unv"])
def test_imported_faces_are_kept_and_bound_the_volume(tmp_path, name, around):
    path = box_faces_in(name, tmp_path)
    models.start("imported")
    gmsh.merge(path)
    surfaces = gmsh.model.getEntities(2)
    assert len(surfaces) == (1 if name == "box.stl" else 6)
    volume = box_around(surfaces) if around else volume_inside(surfaces)
    before = snapshots(surfaces)
    assert all(has_elements(s) for s in surfaces)
    grow(surfaces, [volume])
    assert snapshots(before) == before
    assert_conforming(volume)
    assert signed_volumes(volume).sum() == pytest.approx(26.0 if around else 1.0, rel=1e-6)


def discrete_polygon():
    """Four discrete curves around a unit square."""
    models.start("discrete polygon")
    corner = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    for tag, (x, y, z) in enumerate(corner, 1):
        gmsh.model.addDiscreteEntity(0, tag)
        gmsh.model.setCoordinates(tag, x, y, z)
        gmsh.model.mesh.addNodes(0, tag, [tag], [x, y, z])
        gmsh.model.mesh.addElementsByType(tag, 15, [], [tag])
    for tag in range(1, 5):
        ends = [tag, tag % 4 + 1]
        gmsh.model.addDiscreteEntity(1, tag, ends)
        inside = [np.array(corner[ends[0] - 1]) * (1 - t) + np.array(corner[ends[1] - 1]) * t
                  for t in (0.1, 0.3, 0.6)]
        nodes = [10 * tag + i for i in range(3)]
        gmsh.model.mesh.addNodes(1, tag, nodes, np.ravel(inside))
        chain = [ends[0]] + nodes + [ends[1]]
        gmsh.model.mesh.addElementsByType(
            tag, 1, [], [n for pair in zip(chain, chain[1:]) for n in pair])
    return [(1, tag) for tag in range(1, 5)]


def test_discrete_curves_are_kept_and_a_plane_surface_is_meshed_in_them():
    curves = discrete_polygon()
    geo = gmsh.model.geo
    face = (2, geo.addPlaneSurface([geo.addCurveLoop([tag for _, tag in curves])]))
    geo.synchronize()
    before = snapshots(closure(curves))
    grow(curves, [face], 2)
    assert snapshots(before) == before
    assert_conforming_surfaces(face)
    assert element_count(face) > 20


def test_discrete_entity_without_elements_is_named_as_what_gmsh_cannot_mesh():
    curves = discrete_polygon()
    gmsh.model.addDiscreteEntity(2, 7, [tag for _, tag in curves])
    before = snapshots(closure(curves))
    with pytest.raises(meshgrow.Error, match="Surface 7"):
        grow(curves, [(2, 7)], 2)
    assert snapshots(before) == before


def test_discrete_volume_and_its_faces_are_kept_beside_a_volume_that_is_meshed(tmp_path):
    model = models.box()
    with options(Mesh_MeshSizeMax=0.4):
        gmsh.model.mesh.generate(3)
    path = str(tmp_path / "box.msh")
    gmsh.write(path)
    models.start("imported volume")
    gmsh.merge(path)
    surfaces = gmsh.model.getEntities(2)
    volume = box_around(surfaces)
    before = snapshots(gmsh.model.getEntities(2)[:len(surfaces)] + [model])
    grow(surfaces, [volume])
    assert snapshots(before) == before
    assert_conforming(model, volume)


def reparametrised_ball(tmp_path):
    """The triangles of a sphere as discrete surfaces that Gmsh has parametrised, in a volume."""
    models.single(CLOSED["sphere"])
    with options(Mesh_MeshSizeMax=0.4):
        gmsh.model.mesh.generate(2)
    path = str(tmp_path / "ball.stl")
    gmsh.write(path)
    models.start("read")
    gmsh.merge(path)
    gmsh.model.mesh.classifySurfaces(np.pi, True, True)
    gmsh.model.mesh.createGeometry()
    surfaces = gmsh.model.getEntities(2)
    return surfaces, volume_inside(surfaces)


# test_interruption.py has the message of today.
def test_reparametrised_surfaces_are_kept_and_bound_the_volume(tmp_path):
    surfaces, volume = reparametrised_ball(tmp_path)
    before = snapshots(surfaces + gmsh.model.getEntities(1))
    grow(surfaces, [volume])
    assert snapshots(before) == before
    assert_conforming(volume)
    assert element_count(volume) > 300


def test_reparametrised_surfaces_without_mesh_are_meshed_by_the_field(tmp_path):
    surfaces, _ = reparametrised_ball(tmp_path)
    gmsh.model.mesh.clear(surfaces + gmsh.model.getEntities(1))
    curve = gmsh.model.getEntities(1)[0]
    grow_fixed([curve], surfaces, 0.1, 2)
    assert_conforming_surfaces(*surfaces)
    assert element_count(*surfaces) > 400
