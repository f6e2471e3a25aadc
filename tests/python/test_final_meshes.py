"""The meshes that field.generate leaves behind are valid and graded as asked."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
import reference
from meshes import (boundary, closure, corner_tags, corners, element_count, has_elements, options,
                    premesh, signed_volumes, snapshots)


def mesh_field(sources, attach, growth_rate=1.3, size_limit=0.8):
    field = meshgrow.SizeField()
    field.add_mesh(sources, attach, growth_rate, size_limit)
    return field


# ==== Validity ====


def tet_faces(volume):
    """How often each triangle of nodes is a face of a tetrahedron."""
    tets = corner_tags(volume, "Tetrahedron")
    faces = np.sort(np.concatenate([np.delete(tets, i, axis=1) for i in range(4)]), axis=1)
    unique, counts = np.unique(faces, axis=0, return_counts=True)
    return dict(zip(map(tuple, unique), counts))


def assert_valid(volumes):
    """No negative tetrahedron, none missing or twice, and the faces' triangles are the boundary."""
    for volume in volumes:
        assert signed_volumes(volume).min() > 0
        faces = tet_faces(volume)
        assert max(faces.values()) == 2
        outside = {face for face, count in faces.items() if count == 1}
        triangles = np.concatenate([corner_tags(f, "Triangle") for f in boundary([volume])])
        on_faces = set(map(tuple, np.sort(triangles, axis=1)))
        assert len(on_faces) == len(triangles)
        assert outside == on_faces


SHAPES = {
    "sphere": (lambda occ: occ.addSphere(0, 0, 0, 1), 4 * np.pi / 3),
    "torus": (lambda occ: occ.addTorus(0, 0, 0, 1, 0.4), 2 * np.pi**2 * 0.4**2),
    "cylinder": (lambda occ: occ.addCylinder(0, 0, -0.7, 0, 0, 1.4, 0.7), np.pi * 0.7**2 * 1.4),
    "box": (lambda occ: occ.addBox(-0.6, -0.6, -0.6, 1.2, 1.2, 1.2), 1.2**3),
}


@pytest.mark.parametrize("shape", sorted(SHAPES))
def test_volume_around_a_premeshed_shape_is_filled_by_a_conforming_mesh(shape):
    make, hole = SHAPES[shape]
    model = models.box_in_box_of(make)
    premesh(model.faces, 0.2)
    mesh_field(model.faces, [model.volume]).generate(3)
    assert_valid([model.volume])
    assert signed_volumes(model.volume).sum() == pytest.approx(
        4.0**3 - hole, rel=1e-9 if shape == "box" else 2e-3)


def test_volumes_beside_each_other_share_the_mesh_of_the_face_between():
    model = models.two_boxes()
    premesh([model.between], lambda x, y, z: 0.1 + 0.2 * y)
    mesh_field([model.between], [model.left]).generate(3)
    assert_valid([model.left, model.right])
    for volume in (model.left, model.right):
        assert signed_volumes(volume).sum() == pytest.approx(1.0, rel=1e-9)


def test_premeshed_volume_and_its_neighbour_make_one_conforming_mesh():
    model = models.two_boxes()
    premesh([model.left], 0.25)
    mesh_field([model.between], [model.right]).generate(3)
    assert_valid([model.left, model.right])


def test_nested_volumes_make_one_conforming_mesh():
    volumes = models.nested_boxes(3, smallest=1.5)
    field = meshgrow.SizeField()
    field.add_fixed([models.faces_of(volumes[1][1])[0]], [volumes[1]], 0.4, 1.3, 1.0)
    with options(Mesh_MeshSizeMax=1.2):
        field.generate(3)
    assert_valid(volumes)


def test_premeshed_volume_inside_makes_one_conforming_mesh_with_the_outside():
    model = models.sphere_in_box(side=4.0)
    premesh([model.inner], 0.3)
    mesh_field([model.sphere], [model.outer]).generate(3)
    assert_valid([model.inner, model.outer])
    total = signed_volumes(model.inner).sum() + signed_volumes(model.outer).sum()
    assert total == pytest.approx(4.0**3, rel=1e-9)


# ==== Gradation: the sphere in a box of DESIGN.md, section 6 ====


def test_sphere_in_box_is_as_well_graded_as_promised():
    model = models.sphere_in_box(side=6.0, radius=1.0)
    premesh([model.sphere], lambda x, y, z: 0.09 + 0.06 * z)
    before = snapshots(closure([model.sphere]))
    field = mesh_field([model.sphere], [model.outer], 1.2, 2.0)
    field.generate(3)
    assert snapshots(before) == before
    assert_valid([model.outer])
    report = meshgrow.report(3, [model.outer], field)
    print(meshgrow.report_table({"sphere in box, outer volume": report}))  # pytest -s shows it
    assert report["ratio_max"] <= 1.6
    assert report["ratio_99"] <= 1.30
    assert report["length_share_over_2"] <= 0.005
    assert 60_000 < report["elements"] < 120_000


# ==== Two dimensions ====


def edge_lengths(curve):
    p = corners(curve, "Line")
    return np.linalg.norm(p[:, 1] - p[:, 0], axis=1)


def test_surface_grows_from_a_premeshed_curve():
    model = models.square()
    premesh([model.bottom], lambda x, y, z: 0.02 + 0.05 * x)
    before = snapshots(closure([model.bottom]))
    field = mesh_field([model.bottom], [model.face], 1.2, 0.5)
    field.generate(2)
    assert snapshots(before) == before
    triangles = corners(model.face, "Triangle")
    area = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0],
                                   triangles[:, 2] - triangles[:, 0]), axis=1).sum() / 2
    assert area == pytest.approx(1.0, rel=1e-9)
    report = meshgrow.report(2, [model.face], field)
    assert report["ratio_max"] < 1.7
    assert report["length_share_over_2"] == 0
    assert report["length_median"] == pytest.approx(0.98, abs=0.1)


def test_curves_of_an_attached_surface_are_graded_by_the_field():
    model = models.square()
    premesh([model.bottom], 0.02)
    mesh_field([model.bottom], [model.face], 1.2, 0.5).generate(2)
    for curve in (model.left, model.right):
        p = corners(curve, "Line")
        middle = p.mean(axis=1)
        asked = reference.segments(corners(model.bottom, "Line")).sizes(middle, 1.2, 0.5)
        ratio = edge_lengths(curve) / asked
        assert 0.75 < np.median(ratio) < 1.1
        assert ratio.max() < 1.3


def test_unattached_surface_in_two_dimensions_is_left_to_gmsh():
    models.start("two squares")
    occ = gmsh.model.occ
    occ.fragment([(2, occ.addRectangle(0, 0, 0, 1, 1))], [(2, occ.addRectangle(1, 0, 0, 1, 1))])
    occ.synchronize()
    left, right = sorted(gmsh.model.getEntities(2), key=lambda f: occ.getCenterOfMass(*f)[0])
    outer = next(c for c in boundary([left]) if occ.getCenterOfMass(*c)[0] < 1e-6)
    premesh([outer], 0.02)
    with options(Mesh_MeshSizeMax=0.2):
        mesh_field([outer], [left], 1.5, 0.4).generate(2)
        by_field = element_count(right)
        gmsh.model.mesh.clear()
        gmsh.model.mesh.generate(2)
    assert element_count(right) == pytest.approx(by_field, rel=0.2)


def test_volume_grows_from_a_premeshed_curve():
    volume = models.box(1.0)
    curve = next(c for c in gmsh.model.getEntities(1)
                 if np.allclose(gmsh.model.occ.getCenterOfMass(*c), (0.5, 0, 0)))
    premesh([curve], 0.04)
    before = snapshots(closure([curve]))
    field = mesh_field([curve], [volume], 1.25, 0.5)
    field.generate(3)
    assert snapshots(before) == before
    assert_valid([volume])
    report = meshgrow.report(3, [volume], field)
    assert report["ratio_max"] < 2.0
    assert report["length_share_over_2"] < 0.02
    tets = corners(volume, "Tetrahedron").mean(axis=1)
    near = np.hypot(tets[:, 1], tets[:, 2])
    volumes = signed_volumes(volume)
    assert np.median(volumes[near > 0.8]) > 10 * np.median(volumes[near < 0.1])


def test_source_curve_that_is_no_boundary_of_its_attachment_acts_at_a_distance():
    models.start("curve beside a square")
    occ = gmsh.model.occ
    face = occ.addRectangle(0, 0, 0, 1, 1)
    line = occ.addLine(occ.addPoint(0, -0.2, 0), occ.addPoint(1, -0.2, 0))
    occ.synchronize()
    premesh([(1, line)], 0.02)
    before = snapshots(closure([(1, line)]))
    mesh_field([(1, line)], [(2, face)], 1.2, 0.5).generate(2)
    assert snapshots(before) == before
    bottom = next(c for c in boundary([(2, face)]) if abs(occ.getCenterOfMass(*c)[1]) < 1e-6)
    asked = 0.02 + (1 - 1 / 1.2) * 0.2
    assert np.median(edge_lengths(bottom)) == pytest.approx(asked, rel=0.15)


# ==== Dimensions and chains ====


def test_sources_are_meshed_before_what_grows_from_them_in_a_chain():
    """The curve gives sizes to the face, whose mesh gives sizes to the volume."""
    volume = models.box(1.0)
    faces = models.faces_of(volume[1])
    curve = boundary([faces[0]])[0]
    premesh([curve], 0.05)
    field = meshgrow.SizeField()
    field.add_mesh([curve], [faces[0]], 1.2, 0.3)
    field.add_mesh([faces[0]], [volume], 1.3, 0.5)
    field.generate(3)
    assert_valid([volume])
    sides = reference.triangles(corners(faces[0], "Triangle"))
    assert sides.start.min() < 0.08 and sides.start.max() > 0.15
    points = np.random.default_rng(3).uniform(0, 1, (100, 3))
    np.testing.assert_allclose(field.exact_size(*volume, points), sides.sizes(points, 1.3, 0.5),
                               rtol=1e-5)


def test_generate_of_curves_meshes_no_surface():
    model = models.square()
    premesh([model.bottom], 0.05)
    mesh_field([model.bottom], [model.face]).generate(1)
    assert all(has_elements(c) for c in boundary([model.face]))
    assert not has_elements(model.face)


def test_fixed_size_makes_the_elements_of_that_size():
    volume = models.box(1.0)
    face = models.faces_of(volume[1])[0]
    field = meshgrow.SizeField()
    field.add_fixed([face], [volume], 0.08, 1.3, 0.5)
    field.generate(3)
    assert_valid([volume])
    assert np.median(reference.triangles(corners(face, "Triangle")).start) == pytest.approx(
        0.08, rel=0.1)


# ==== Quadrilaterals ====


def test_premeshed_quadrilaterals_are_kept_and_pyramids_laid_on_them():
    model = models.box_in_box_of(SHAPES["box"][0])
    with options(Mesh_RecombineAll=1):
        premesh(model.faces, 0.3)
    quads = np.concatenate([quad_tags(f) for f in model.faces])
    assert len(quads) > 50
    before = snapshots(closure(model.faces))
    field = mesh_field(model.faces, [model.volume])
    field.generate(3)
    assert snapshots(before) == before
    pyramids = corner_tags(model.volume, "Pyramid")
    bases = {frozenset(p) for p in pyramids[:, :4].tolist()}
    assert {frozenset(q) for q in quads.tolist()} <= bases
    assert meshgrow.report(3, [model.volume], field)["length_share_over_2"] < 0.05


def quad_tags(face):
    return np.concatenate((corner_tags(face, "Quadrilateral"), corner_tags(face, "Quadrangle")))
