"""Opposite sides of mapped (transfinite) surfaces get equal numbers of intervals."""

import gmsh
import meshgrow
import numpy as np
import pytest

import meshes
import models
from meshes import element_count, options, premesh, snapshots


def rectangles(count):
    """Unit squares in a row; faces, bottoms, tops, and the curves across at x = 0, 1, …"""
    models.start("rectangles")
    occ = gmsh.model.occ
    made = [(2, occ.addRectangle(i, 0, 0, 1, 1)) for i in range(count)]
    if count > 1:
        occ.fragment(made[:1], made[1:])
    occ.synchronize()
    faces = sorted(gmsh.model.getEntities(2), key=lambda e: occ.getCenterOfMass(*e)[0])
    bottoms, tops, across = {}, {}, {}
    for curve in gmsh.model.getEntities(1):
        x, y, _ = occ.getCenterOfMass(*curve)
        if abs(y - 0.5) < 1e-6:
            across[round(x)] = curve
        else:
            (bottoms if y < 0.5 else tops)[int(x)] = curve
    return faces, bottoms, tops, across


def is_structured(face, *counts):
    """Two triangles for each cell of a grid with these numbers of intervals."""
    return element_count(face) == 2 * counts[0] * counts[1]


def upper_left():
    return next(p for p in gmsh.model.getEntities(0)
                if np.allclose(gmsh.model.getValue(0, p[1], []), (0, 1, 0)))


@pytest.mark.parametrize("kernel", ["occ", "geo"])
def test_opposite_sides_get_the_larger_number(kernel):
    if kernel == "occ":
        (face,), bottoms, tops, across = rectangles(1)
        sides = (bottoms[0], tops[0]), (across[0], across[1])
    else:
        models.start("geo")
        geo = gmsh.model.geo
        points = [geo.addPoint(*p, 0) for p in ((0, 0), (1, 0), (1, 1), (0, 1))]
        lines = [geo.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
        face = (2, geo.addPlaneSurface([geo.addCurveLoop(lines)]))
        geo.synchronize()
        sides = ((1, lines[0]), (1, lines[2])), ((1, lines[3]), (1, lines[1]))
    gmsh.model.mesh.setTransfiniteSurface(face[1])
    field = meshgrow.SizeField()
    field.add_fixed([upper_left()], [face], 0.02, 1.2, 0.5)
    field.generate(2)
    counts = [[element_count(c) for c in pair] for pair in sides]
    assert counts[0][0] == counts[0][1] and counts[1][0] == counts[1][1]
    assert is_structured(face, counts[0][0], counts[1][0])
    # Without the mapping, the far sides get fewer and the near ones as many.
    gmsh.model.mesh.clear()
    gmsh.model.mesh.removeConstraints([face]) if hasattr(gmsh.model.mesh, "removeConstraints") \
        else gmsh.model.mesh.setTransfiniteSurface(face[1])
    if hasattr(gmsh.model.mesh, "removeConstraints"):
        field.generate(1)
        free = [[element_count(c) for c in pair] for pair in sides]
        assert [max(pair) for pair in free] == [pair[0] for pair in counts]
        assert min(free[0]) < counts[0][0]


def test_the_grading_of_an_adjusted_side_survives():
    (face,), bottoms, tops, across = rectangles(1)
    gmsh.model.mesh.setTransfiniteSurface(face[1])
    field = meshgrow.SizeField()
    field.add_fixed([upper_left()], [face], 0.02, 1.2, 0.5)
    field.generate(2)
    ends = meshes.corners(bottoms[0], "Line")
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    asked = field.size(*bottoms[0], ends.mean(axis=1))
    ratio = length / asked
    # All scaled alike, far below what was asked; a uniform curve would spread like the sizes do.
    assert ratio.mean() < 0.8
    assert ratio.max() / ratio.min() < 1.25 < asked.max() / asked.min()


@pytest.mark.parametrize("count", [3, 20])
def test_a_prescribed_number_rules_its_opposite_side(count):
    (face,), bottoms, tops, across = rectangles(1)
    gmsh.model.mesh.setTransfiniteSurface(face[1])
    gmsh.model.mesh.setTransfiniteCurve(bottoms[0][1], count + 1)
    field = meshgrow.SizeField()
    field.add_fixed([upper_left()], [face], 0.04, 1.2, 0.5)
    field.generate(2)
    assert element_count(bottoms[0]) == element_count(tops[0]) == count
    assert is_structured(face, count, element_count(across[0]))


@pytest.mark.parametrize("size", [0.5, 0.05])
def test_a_premeshed_side_rules_and_is_kept(size):
    (face,), bottoms, tops, across = rectangles(1)
    gmsh.model.mesh.setTransfiniteSurface(face[1])
    premesh([bottoms[0]], size)
    before = snapshots(meshes.closure([bottoms[0]]))
    field = meshgrow.SizeField()
    field.add_fixed([upper_left()], [face], 0.1, 1.2, 0.5)
    field.generate(2)
    assert snapshots(meshes.closure([bottoms[0]])) == before
    assert element_count(tops[0]) == element_count(bottoms[0])


def test_a_number_goes_through_a_chain_of_faces():
    faces, bottoms, tops, across = rectangles(4)
    for face in faces:
        gmsh.model.mesh.setTransfiniteSurface(face[1])
    gmsh.model.mesh.setTransfiniteCurve(across[4][1], 14)
    field = meshgrow.SizeField()
    field.add_fixed([upper_left()], faces, 0.1, 1.2, 0.5)
    field.generate(2)
    assert {element_count(c) for c in across.values()} == {13}
    for i, face in enumerate(faces):
        assert element_count(bottoms[i]) == element_count(tops[i])
        assert is_structured(face, element_count(bottoms[i]), 13)


def test_unattached_sides_are_matched_too():
    (face,), bottoms, tops, across = rectangles(1)
    gmsh.model.mesh.setTransfiniteSurface(face[1])
    ends = [p for p in gmsh.model.getEntities(0) if gmsh.model.getValue(0, p[1], [])[1] > 0.5]
    gmsh.model.mesh.setSize(gmsh.model.getEntities(0), 0.2)
    gmsh.model.mesh.setSize(ends, 0.05)
    meshgrow.SizeField().generate(2)
    assert element_count(tops[0]) == element_count(bottoms[0]) == 20


def test_sides_of_several_curves_are_matched_by_their_sums():
    models.start("notched")
    geo = gmsh.model.geo
    points = [geo.addPoint(*p, 0) for p in ((0, 0), (0.3, 0), (1, 0), (1, 1), (0, 1))]
    lines = [geo.addLine(points[i], points[(i + 1) % 5]) for i in range(5)]
    face = (2, geo.addPlaneSurface([geo.addCurveLoop(lines)]))
    geo.synchronize()
    gmsh.model.mesh.setTransfiniteSurface(face[1], "Left", [points[0]] + points[2:])
    field = meshgrow.SizeField()
    field.add_fixed([(0, points[4])], [face], 0.03, 1.2, 0.5)
    field.generate(2)
    counts = [element_count((1, line)) for line in lines]
    assert counts[0] + counts[1] == counts[3] and counts[2] == counts[4]
    assert is_structured(face, counts[3], counts[4])


def test_two_fixed_unequal_sides_are_refused():
    (face,), bottoms, tops, across = rectangles(1)
    gmsh.model.mesh.setTransfiniteSurface(face[1])
    gmsh.model.mesh.setTransfiniteCurve(bottoms[0][1], 6)
    gmsh.model.mesh.setTransfiniteCurve(tops[0][1], 9)
    with pytest.raises(meshgrow.Error) as refusal:
        meshgrow.SizeField().generate(2)
    for name in ("Surface %d" % face[1], "Curve %d (fixed at 5)" % bottoms[0][1],
                 "Curve %d (fixed at 8)" % tops[0][1]):
        assert name in str(refusal.value)


@pytest.mark.parametrize("recombined", [False, True])
def test_a_mapped_neighbour_grows_from_the_common_side_as_it_is_meshed(recombined):
    faces, bottoms, tops, across = rectangles(2)
    for face in faces:
        gmsh.model.mesh.setTransfiniteSurface(face[1])
    if recombined:
        gmsh.model.mesh.setRecombine(2, faces[1][1])
    field = meshgrow.SizeField()
    field.add_fixed([upper_left()], [faces[0]], 0.02, 1.2, 0.3)
    field.add_mesh([across[1]], [faces[1]], 1.2, 0.3)
    field.generate(2)
    assert len({element_count(c) for c in across.values()}) == 1
    assert element_count(bottoms[1]) == element_count(tops[1]) < element_count(tops[0])
    cells = element_count(tops[1]) * element_count(across[1])
    assert element_count(faces[1]) == (1 if recombined else 2) * cells


def test_mapped_volumes_are_meshed_by_structure_also_from_a_source_face():
    model = models.two_boxes()
    for _, tag in gmsh.model.getEntities(2):
        gmsh.model.mesh.setTransfiniteSurface(tag)
    for _, tag in gmsh.model.getEntities(3):
        gmsh.model.mesh.setTransfiniteVolume(tag)
    corner = next(p for p in gmsh.model.getEntities(0)
                  if np.allclose(gmsh.model.getValue(0, p[1], []), 0))
    field = meshgrow.SizeField()
    field.add_fixed([corner], [model.left], 0.05, 1.2, 0.5)
    field.add_mesh([model.between], [model.right], 1.2, 0.5)
    field.generate(3)
    def intervals(volume):
        return [element_count(c) for c in meshes.closure([volume]) if c[0] == 1]
    for volume in (model.left, model.right):
        counts = sorted(intervals(volume))
        # Four curves in each direction; a cell makes six tetrahedra.
        assert counts[0:4] == [counts[0]] * 4 and counts[8:] == [counts[8]] * 4
        assert element_count(volume) == 6 * counts[0] * counts[4] * counts[8]


def test_options_are_as_before_after_adjusting():
    (face,), *_ = rectangles(1)
    gmsh.model.mesh.setTransfiniteSurface(face[1])
    field = meshgrow.SizeField()
    field.add_fixed([upper_left()], [face], 0.05, 1.2, 0.5)
    with options(Mesh_MeshSizeMin=0.01, Mesh_MeshSizeMax=0.4, Mesh_MeshSizeFactor=0.9):
        field.generate(2)
        assert [gmsh.option.getNumber("Mesh.MeshSize" + name) for name in
                ("Min", "Max", "Factor")] == [0.01, 0.4, 0.9]


def test_odd_numbers_of_gmsh_itself_beside_quads_may_be_changed():
    """Two mapped faces of quadrangles, left and right of a curve; Gmsh sizes the right one alone."""
    models.start("two mapped faces")
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.8)
    geo = gmsh.model.geo
    low, high = ([geo.addPoint(x, y, 0) for x in (0, 0.5, 3.5)] for y in (0, 2))
    across = [geo.addLine(a, b) for a, b in zip(low, high)]
    bottoms, tops = ([geo.addLine(line[i], line[i + 1]) for i in (0, 1)] for line in (low, high))
    faces = [geo.addPlaneSurface([geo.addCurveLoop([bottoms[i], across[i + 1], -tops[i],
                                                    -across[i]])]) for i in (0, 1)]
    geo.synchronize()
    for face in faces:
        gmsh.model.mesh.setTransfiniteSurface(face)
        gmsh.model.mesh.setRecombine(2, face)
    field = meshgrow.SizeField()
    field.add_fixed([(0, high[0])], [(2, faces[0])], 0.03, 1.2, 0.12)
    field.generate(2)
    for i, face in enumerate(faces):
        counts = [element_count((1, curve)) for curve in (bottoms[i], tops[i], across[i])]
        assert counts[0] == counts[1]
        assert element_count((2, face)) == counts[0] * counts[2]


def test_a_premeshed_side_rules_sides_that_gmsh_makes_finer_than_the_field():
    """Gmsh's own size, a tenth of the model's diagonal, is below what the field asks for there."""
    model = models.square()
    premesh([model.bottom], 0.2)
    count = element_count(model.bottom)  # 5; 4.8 lets no size exceed its own
    gmsh.model.mesh.setTransfiniteSurface(model.face[1])
    field = meshgrow.SizeField()
    field.add_mesh([model.bottom], [model.face], 1.2, 0.5)
    field.generate(2)
    assert element_count(model.bottom) == element_count(model.top) == count
    assert element_count(model.left) == element_count(model.right)
