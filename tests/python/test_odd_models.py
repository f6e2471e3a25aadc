"""Models and scripts that have led astray: each a small case of its own."""

import gmsh
import meshgrow
import numpy as np
import pytest

import meshes
import models
from kinds import face_at
from meshes import Log, assert_conforming, boundary, element_count, has_elements, premesh, snapshots

SHIFT = [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]  # by 1 along x


def test_curves_that_gmsh_splits_itself_are_no_error():
    """Coarse curves of a thin ring intersect in the plane, and Gmsh splits their elements."""
    models.start("thin ring")
    occ = gmsh.model.occ
    occ.cut([(2, occ.addDisk(0, 0, 0, 1, 1))], [(2, occ.addRectangle(-.68, -.68, 0, 1.36, 1.36))])
    occ.synchronize()
    (face,) = gmsh.model.getEntities(2)
    field = meshgrow.SizeField()
    field.add_fixed(gmsh.model.getEntities(0)[:1], [face], 3, 1.2, 3)
    with meshes.options(Mesh_MeshSizeMin=1, Mesh_MeshSizeMax=3):
        field.generate(2)
    assert has_elements(face)
    meshes.assert_conforming_surfaces(face)


def square_in_a_disk():
    """The corners of the square come so close to the circle that coarse elements intersect."""
    models.start("square in a disk")
    occ = gmsh.model.occ
    occ.fragment([(2, occ.addDisk(0, 0, 0, 1, 1))],
                 [(2, occ.addRectangle(-.68, -.68, 0, 1.36, 1.36))])
    occ.synchronize()
    square, ring = sorted(gmsh.model.getEntities(2), key=lambda f: len(boundary([f])))
    return square, ring


def grow_from_the_square(square, ring):
    field = meshgrow.SizeField()
    field.add_fixed(gmsh.model.getEntities(0)[:1], [square], 3, 1.2, 3)
    field.add_mesh([square], [ring], 1.2, 3)
    with meshes.options(Mesh_MeshSizeMin=1, Mesh_MeshSizeMax=3):
        field.generate(2)


def test_curves_that_gmsh_splits_are_no_error_where_a_source_stands_on_them():
    """The square is meshed before the ring, under which its sides are split: it is meshed anew."""
    square, ring = square_in_a_disk()
    grow_from_the_square(square, ring)
    assert sum(element_count(c) for c in boundary([square])) > 4
    meshes.assert_conforming_surfaces(square, ring)


def test_curves_meshed_before_that_gmsh_would_split_are_kept_and_named():
    square, ring = square_in_a_disk()
    premesh([square], 3)
    before = snapshots(meshes.closure([square]))
    with pytest.raises(meshgrow.Error, match="Gmsh gave Curve .* other elements .* smaller sizes"):
        grow_from_the_square(square, ring)
    assert snapshots(before) == before


def test_a_volume_of_one_tetrahedron_keeps_it():
    models.start("tetrahedron")
    geo = gmsh.model.geo
    p = [geo.addPoint(*x) for x in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))]
    lines = {(a, b): geo.addLine(p[a], p[b]) for a in range(4) for b in range(a + 1, 4)}
    faces = [geo.addPlaneSurface([geo.addCurveLoop([lines[a, b], lines[b, c], -lines[a, c]])])
             for a, b, c in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))]
    volume = (3, geo.addVolume([geo.addSurfaceLoop(faces)]))
    geo.synchronize()
    for curve in lines.values():
        gmsh.model.mesh.setTransfiniteCurve(curve, 2)
    meshgrow.SizeField().generate(3)
    assert element_count(volume) == 1


def test_a_structured_source_acts_as_long_as_it_is_needed():
    """A mapped face of a mapped volume is meshed early, loses its mesh to curves, and still acts."""
    models.start("row")
    occ = gmsh.model.occ
    boxes = [(3, occ.addBox(i, 0, 0, 1, 1, 1)) for i in range(3)]
    occ.fragment(boxes[:1], boxes[1:])
    occ.synchronize()
    volumes = sorted(gmsh.model.getEntities(3), key=lambda e: occ.getCenterOfMass(*e)[0])
    first, middle, last = volumes
    between = [(set(models.faces_of(a[1])) & set(models.faces_of(b[1]))).pop()
               for a, b in ((first, middle), (middle, last))]
    for face in models.faces_of(first[1]):
        gmsh.model.mesh.setTransfiniteSurface(face[1])
    gmsh.model.mesh.setTransfiniteVolume(first[1])
    field = meshgrow.SizeField(strict=True)
    field.add_fixed([between[0]], [between[0]], 0.1, 1.0, 0.1)
    field.add_mesh(between, [middle], 1.2, 0.6)
    field.add_mesh([between[0]], [between[1]], 1.2, 0.6)
    with Log() as log:
        field.generate(3)
    assert not [w for w in log.warnings if "no mesh" in w]
    near = meshgrow.report(3, [middle], field)
    assert near["smallest_size"] < 0.2 and near["length_share_over_2"] < 0.02
    assert_conforming(*volumes)


@pytest.mark.parametrize("kernel", ["geo", "occ"])
def test_nothing_is_left_in_the_kernels_of_gmsh(kernel):
    models.start("points")
    make = getattr(gmsh.model, kernel)
    if kernel == "geo":
        corner = [make.addPoint(x, y, 0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        lines = [make.addLine(corner[i], corner[(i + 1) % 4]) for i in range(4)]
        make.addPlaneSurface([make.addCurveLoop(lines)])
    else:
        make.addRectangle(0, 0, 0, 1, 1)
    make.synchronize()
    # To ask Gmsh's own kernel where it was never used ends 4.8.
    kernels = [make]
    if kernel == "occ" and not gmsh.option.getString("General.Version").startswith("4.8"):
        kernels.append(gmsh.model.geo)

    def state():
        for used in kernels:
            used.synchronize()
        return gmsh.model.getEntities(), max(used.getMaxTag(0) for used in kernels)
    before = state()
    field = meshgrow.SizeField()
    field.plan(2)
    field.generate(2)
    assert state() == before


def test_a_prescribed_odd_number_of_an_arc_beside_quads_is_taken_as_it_is():
    """Of arcs Gmsh does not tell what is prescribed."""
    models.start("arc")
    occ = gmsh.model.occ
    a, b, c, d, m = (occ.addPoint(*p, 0) for p in ((-1, 0), (1, 0), (1, 1), (-1, 1), (0, -1)))
    arc = occ.addCircleArc(a, m, b)
    lines = [occ.addLine(*ends) for ends in ((b, c), (c, d), (d, a))]
    face = occ.addPlaneSurface([occ.addCurveLoop([arc] + lines)])
    occ.synchronize()
    for curve in (arc, lines[1]):
        gmsh.model.mesh.setTransfiniteCurve(curve, 6)
    gmsh.model.mesh.setTransfiniteSurface(face)
    gmsh.model.mesh.setRecombine(2, face)
    meshgrow.SizeField().generate(2)
    assert element_count((1, arc)) == element_count((1, lines[1])) == 5
    assert element_count((1, lines[0])) == element_count((1, lines[2]))


def test_a_mapped_triangle_without_corners_takes_the_corner_that_fits():
    for counts in ((5, 5, 7), (5, 7, 5), (7, 5, 5)):
        models.start("triangle %s" % (counts,))
        geo = gmsh.model.geo
        p = [geo.addPoint(*x, 0) for x in ((0, 0), (1, 0), (0, 1))]
        lines = [geo.addLine(p[i], p[(i + 1) % 3]) for i in range(3)]
        face = geo.addPlaneSurface([geo.addCurveLoop(lines)])
        geo.synchronize()
        for line, count in zip(lines, counts):
            gmsh.model.mesh.setTransfiniteCurve(line, count)
        gmsh.model.mesh.setTransfiniteSurface(face)
        if counts == (7, 5, 5):
            # Gmsh tries two corners of three.
            with pytest.raises(meshgrow.Error, match="opposite sides"):
                meshgrow.SizeField().generate(2)
        else:
            meshgrow.SizeField().generate(2)
            assert has_elements((2, face))


# ==== Periodic sources ====


def periodic_square():
    model = models.square()
    gmsh.model.mesh.setPeriodic(1, [model.right[1]], [model.left[1]], SHIFT)
    return model


def test_a_periodic_copy_may_be_the_only_source():
    model = periodic_square()
    field = meshgrow.SizeField()
    field.add_fixed([model.left], [model.left], 0.05, 1.0, 0.05)
    field.add_mesh([model.right], [model.face], 1.2, 0.5)
    field.generate(2)
    assert element_count(model.right) == element_count(model.left) == 20
    assert meshgrow.report(2, [model.face], field)["length_share_over_2"] < 0.02


def test_remesh_keeps_the_master_of_a_source():
    model = periodic_square()
    premesh([model.left, model.right], 0.05)
    field = meshgrow.SizeField()
    field.add_mesh([model.right], [model.face], 1.2, 0.5)
    field.generate(2)
    before = snapshots([model.left, model.right])
    field.generate(2, remesh=True)
    assert snapshots(before) == before and has_elements(model.face)


def test_remesh_that_cannot_succeed_clears_nothing():
    model = models.square()
    gmsh.model.mesh.generate(2)
    before = snapshots(gmsh.model.getEntities())
    field = meshgrow.SizeField()
    with pytest.raises(meshgrow.Error, match="dimension 4"):
        field.generate(4, remesh=True)
    with meshes.options(Mesh_SubdivisionAlgorithm=1):
        with pytest.raises(meshgrow.Error, match="SubdivisionAlgorithm"):
            field.generate(2, remesh=True)
    assert snapshots(before) == before
    assert has_elements(model.face)


# ==== Premeshed without what belongs to it ====


def test_a_premeshed_surface_without_its_curves_is_refused():
    volume = models.box()
    face = face_at(volume, 2, 0.0)
    gmsh.model.mesh.addNodes(2, face[1], [901, 902, 903, 904],
                             [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0])
    gmsh.model.mesh.addElementsByType(face[1], 2, [], [901, 902, 903, 901, 903, 904])
    field = meshgrow.SizeField()
    field.add_mesh([face], [volume], 1.2, 0.5)
    with pytest.raises(meshgrow.Error, match="Surface %d has a mesh, but Curve" % face[1]):
        field.generate(3)


def test_a_premeshed_face_of_a_mapped_volume_needs_all_curves():
    volume = models.box()
    for _, tag in gmsh.model.getEntities(2):
        gmsh.model.mesh.setTransfiniteSurface(tag)
    for _, tag in gmsh.model.getEntities(1):
        gmsh.model.mesh.setTransfiniteCurve(tag, 5)
    gmsh.model.mesh.setTransfiniteVolume(volume[1])
    face = face_at(volume, 2, 0.0)
    premesh([face], 0.25)
    before = snapshots(meshes.closure([face]))
    with pytest.raises(meshgrow.Error, match="Volume %d is mapped.*Surface %d" % (volume[1], face[1])):
        meshgrow.SizeField().generate(3)
    assert snapshots(before) == before


# ==== The user's sizes and registration ====


@pytest.mark.parametrize("answer", [None, "0.1", 1j], ids=["None", "text", "complex"])
def test_an_answer_that_is_no_number_is_raised(answer):
    model = models.square()
    field = meshgrow.SizeField()
    field.combine(lambda dim, tag, x, y, z, lc: answer)
    if answer == "0.1":
        field.generate(2)  # float("0.1") is a number
        assert element_count(model.face) > 100
    else:
        with pytest.raises(TypeError):
            field.generate(2)


def test_what_a_former_callback_raised_does_not_stop_the_next():
    model = models.square()
    field = meshgrow.SizeField()
    field.combine(lambda dim, tag, x, y, z, lc: 1 / 0)
    field.register()
    gmsh.model.mesh.generate(1)
    field.unregister()
    field.combine(lambda dim, tag, x, y, z, lc: 0.05)
    gmsh.model.mesh.clear()
    field.generate(2)
    assert element_count(model.face) > 500


def test_a_registered_field_reads_late_sources_after_its_own_generate_too():
    model = models.square(2.0)
    field = meshgrow.SizeField()
    field.add_fixed([model.left], [model.left], 0.05, 1.0, 0.05)
    field.add_mesh([model.left], [model.face], 1.2, 0.5)
    field.register()
    field.generate(2)
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(2)
    assert meshgrow.report(2, [model.face], field)["smallest_size"] < 0.08


def test_sources_of_which_only_some_come_in_time_are_read():
    """A curve is meshed before the surface that grows from it; another source surface is not."""
    model = models.two_boxes()
    target = face_at(model.right, 2, 0.0)
    other = face_at(model.right, 2, 1.0)
    curve = next(c for c in boundary([model.between])
                 if c in boundary([target]))
    field = meshgrow.SizeField()
    field.add_fixed([curve], [curve], 0.05, 1.0, 0.05)
    field.add_mesh([curve, other], [target], 1.2, 0.5)
    field.register()
    with meshes.options(Mesh_MeshSizeExtendFromBoundary=0):
        gmsh.model.mesh.generate(2)
    assert element_count(target) > 4 * element_count(other) or \
        meshgrow.report(2, [target])["smallest_size"] < 0.08
    ends = meshes.corners(target, "Triangle")
    near = ends.mean(axis=1)[:, 0] < 1.2
    size = np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2).mean(axis=1)
    assert size[near].mean() < 0.12
