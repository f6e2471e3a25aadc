"""Every way in which Gmsh meshes an entity: premeshed it is kept to the bit, unmeshed it is meshed
as plain Gmsh meshes it: structured, recombined, reversed, of higher order."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from child import run_child
from kinds import coordinates, face_at, grow, quads_in, triangles_in
from meshes import (assert_conforming, assert_conforming_surfaces, boundary, closure, corner_tags,
                    corners, element_count, options, premesh, snapshots)


# ==== Transfinite curves, surfaces and volumes ====


@pytest.mark.parametrize("premeshed", [True, False])
def test_transfinite_curve_has_its_count(premeshed):
    """The curve is 12 intervals growing by 1.2, whatever the field asks on it."""
    model = models.square()
    gmsh.model.mesh.setTransfiniteCurve(model.top[1], 13, "Progression", 1.2)
    premesh([model.bottom] + premeshed * [model.top], 0.02)
    before = snapshots(closure([model.bottom] + premeshed * [model.top]))
    grow([model.bottom], [model.face], 2)
    assert snapshots(before) == before
    assert element_count(model.top) == 12
    lengths = np.sort(np.linalg.norm(np.diff(corners(model.top, "Line"), axis=1), axis=2).ravel())
    assert lengths[1:] / lengths[:-1] == pytest.approx(1.2, abs=0.02)
    assert_conforming_surfaces(model.face)


def transfinite_box(face_only=False, recombine=False, count=5):
    volume = models.box()
    faces = [face_at(volume, 2, 0.0)] if face_only else models.faces_of(volume[1])
    for _, curve in {c for f in faces for c in boundary([f])}:
        gmsh.model.mesh.setTransfiniteCurve(curve, count)
    for face in faces:
        gmsh.model.mesh.setTransfiniteSurface(face[1])
        if recombine:
            gmsh.model.mesh.setRecombine(*face)
    return volume, faces


@pytest.mark.parametrize("recombine", [False, True], ids=["triangles", "quads"])
@pytest.mark.parametrize("premeshed", [True, False])
def test_transfinite_surface_is_structured(premeshed, recombine):
    volume, (face,) = transfinite_box(True, recombine)
    top = face_at(volume, 2, 1.0)
    premesh([top] + premeshed * [face], 0.12)
    before = snapshots(closure([top] + premeshed * [face]))
    grow([top], [volume], 2 if recombine else 3)
    assert snapshots(before) == before
    assert np.allclose(np.unique(coordinates(face)[:, :2].round(6)), (.25, .5, .75))
    assert len(coordinates(face)) == 9
    assert (quads_in(face), triangles_in(face)) == ((16, 0) if recombine else (0, 32))
    if not recombine:
        assert_conforming(volume)


@pytest.mark.parametrize("recombine", [False, True], ids=["tetrahedra", "hexahedra"])
@pytest.mark.parametrize("premeshed", [
    "nothing",
    "faces", "volume"])
def test_transfinite_volume_is_structured(premeshed, recombine):
    volume, faces = transfinite_box(recombine=recombine)
    gmsh.model.mesh.setTransfiniteVolume(volume[1])
    kept = {"nothing": [], "faces": faces, "volume": [volume]}[premeshed]
    premesh(kept, 0.3)
    before = snapshots(closure(kept))
    grow(faces[:1], [volume])
    assert snapshots(before) == before
    assert len(coordinates(volume)) == 27
    assert np.allclose(np.unique(coordinates(volume).round(6)), (.25, .5, .75))
    kinds = {"Hexahedron": 64} if recombine else {"Tetrahedron": 64 * 6}
    for name, count in kinds.items():
        assert len(corner_tags(volume, name)) == count == element_count(volume)
    assert_conforming(volume)


def test_transfinite_volume_with_one_premeshed_face_is_told_as_impossible():
    """Gmsh forgets the structure of a face when it meshes curves, and has no way to tell it."""
    volume, faces = transfinite_box()
    gmsh.model.mesh.setTransfiniteVolume(volume[1])
    premesh(faces[:1], 0.3)
    before = snapshots(closure(faces[:1]))
    with pytest.raises(meshgrow.Error, match="Volume %d" % volume[1]):
        grow(faces[:1], [volume])
    assert snapshots(before) == before


# ==== Recombined surfaces ====


@pytest.mark.parametrize("premeshed", [True, False])
def test_recombined_surface_has_quads(premeshed):
    volume = models.box()
    bottom, top = face_at(volume, 2, 0.0), face_at(volume, 2, 1.0)
    gmsh.model.mesh.setRecombine(*bottom)
    premesh([top] + premeshed * [bottom], 0.15)
    before = snapshots(closure([top] + premeshed * [bottom]))
    grow([top] + premeshed * [bottom], [volume], 2)
    assert snapshots(before) == before
    assert quads_in(bottom) > 5 * triangles_in(bottom)
    assert quads_in(top) == 0
    assert_conforming_surfaces(*models.faces_of(volume[1]))


PYRAMIDS = """
import gmsh, meshgrow
from kinds import quads_in
from test_kinds_of_meshing import transfinite_box
from meshes import assert_conforming, closure, corner_tags, premesh, snapshots
gmsh.initialize(readConfigFiles=False)
gmsh.option.setNumber("General.Terminal", 0)
volume, (face,) = transfinite_box(True, True, 11)
premesh([face], 0.1)
before = snapshots(closure([face]))
field = meshgrow.SizeField()
field.add_mesh([face], [volume], 1.3, 0.5)
field.generate(3)
assert snapshots(before) == before
assert_conforming(volume)
print(quads_in(face), len(corner_tags(volume, "Pyramid")))
"""


def test_volume_beside_a_premeshed_transfinite_surface_of_quads_has_pyramids_on_it():
    """In a process of its own: Gmsh 4.8 aborts where a second session makes pyramids."""
    assert run_child(PYRAMIDS) == ["100 100"]


def test_recombined_square_grows_from_a_premeshed_curve():
    model = models.square()
    gmsh.model.mesh.setRecombine(*model.face)
    premesh([model.bottom], 0.05)
    before = snapshots(closure([model.bottom]))
    grow([model.bottom], [model.face], 2)
    assert snapshots(before) == before
    assert quads_in(model.face) > 10 * triangles_in(model.face)
    assert_conforming_surfaces(model.face)


# ==== Reversed meshes ====


@pytest.mark.parametrize("dim", [2, 3])  # an even and an odd number of passes
@pytest.mark.parametrize("premeshed", [True, False])
def test_reversed_curve_and_surface_are_reversed_once(premeshed, dim):
    """Every run of Gmsh reverses what is to be reversed again, premeshed or not."""
    volume = models.box()
    face = face_at(volume, 2, 0.0)
    curve = boundary([face])[0]
    for entity in (face, curve):
        gmsh.model.mesh.setReverse(*entity)
    premesh([face] * premeshed, 0.2)
    before = snapshots(closure([face])) if premeshed else {}
    grow([face], [volume], dim)
    assert snapshots(before) == before
    if not premeshed:  # premesh() itself takes several runs of Gmsh
        line = corners(curve, "Line")
        tangent = gmsh.model.getDerivative(*curve, [0.5])
        assert ((line[:, 1] - line[:, 0]) @ tangent < 0).all()
    a, b, c = np.moveaxis(corners(face, "Triangle"), 1, 0)
    normals = np.cross(b - a, c - a)
    cad = gmsh.model.getNormal(face[1], [0.5, 0.5])
    assert (normals @ cad < 0).all()


# ==== Higher order ====


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("shape", ["box", "sphere"])
def test_premesh_of_higher_order_is_kept_in_a_mesh_of_that_order(shape, order):
    make = {"box": lambda occ: occ.addBox(-.6, -.6, -.6, 1.2, 1.2, 1.2),
            "sphere": lambda occ: occ.addSphere(0, 0, 0, 1)}[shape]
    model = models.box_in_box_of(make)
    premesh(model.faces, 0.5)
    gmsh.model.mesh.setOrder(order)
    before = snapshots(closure(model.faces))
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    grow(model.faces, [model.volume], size_limit=1.0)
    assert snapshots(before) == before
    kinds = {2: (9, 11), 3: (21, 29)}[order]
    for face in model.faces + model.walls:
        assert list(gmsh.model.mesh.getElementTypes(*face)) == [kinds[0]]
        nodes = {n for block in gmsh.model.mesh.getElements(*face)[2] for n in block}
        volume_nodes = {n for block in gmsh.model.mesh.getElements(*model.volume)[2] for n in block}
        assert nodes <= volume_nodes
    assert list(gmsh.model.mesh.getElementTypes(*model.volume)) == [kinds[1]]
    assert_conforming(model.volume)


@pytest.mark.parametrize("order", [2, 3])
def test_premeshed_volume_of_higher_order_is_kept(order):
    model = models.two_boxes()
    premesh([model.left], 0.4)
    gmsh.model.mesh.setOrder(order)
    before = snapshots(closure([model.left]))
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    grow([model.between], [model.right])
    assert snapshots(before) == before
    assert_conforming(model.left, model.right)


@pytest.mark.parametrize("order", [2, 3])
def test_premeshed_curve_of_higher_order_is_kept(order):
    model = models.square()
    premesh([model.bottom], 0.1)
    gmsh.model.mesh.setOrder(order)
    before = snapshots(closure([model.bottom]))
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    grow([model.bottom], [model.face], 2)
    assert snapshots(before) == before
    assert_conforming_surfaces(model.face)
