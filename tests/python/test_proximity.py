"""Proximity size functions: gaps measured through the attachments, cells counted in the mesh."""

import math

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from meshes import cells_along, everything_in_the_model, premesh
from reference import gap_size

GROWTH = 1.2
CELLS = 3
DEGREES_10 = math.radians(10)


def proximity_field(sources, attach, cells=CELLS, size_limit=2.0, how=None, **options):
    field = meshgrow.SizeField(**(how or {"evaluator": "exact"}))
    field.add_proximity(sources, attach, cells, GROWTH, size_limit, **options)
    return field


def volume_of(make):
    """The volume that is left after `make(occ)`."""
    models.start("gaps")
    make(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    return gmsh.model.getEntities(3)[-1]


def plate(occ):
    occ.addBox(0, 0, 0, 6, 6, 1)


def shell(occ):
    occ.cut([(3, occ.addSphere(0, 0, 0, 2))], [(3, occ.addSphere(0, 0, 0, 1.5))])


def wedge(occ):
    points = [occ.addPoint(0, 0, 0), occ.addPoint(10, 0, 0),
              occ.addPoint(10, 10 * math.tan(DEGREES_10), 0)]
    loop = occ.addCurveLoop([occ.addLine(points[i], points[(i + 1) % 3]) for i in range(3)])
    occ.extrude([(2, occ.addPlaneSurface([loop]))], 0, 0, 4)


def plate_with_holes(occ):
    block = occ.addBox(0, 0, 0, 8, 6, 1)
    occ.cut([(3, block)], [(3, occ.addCylinder(2, 3, -1, 0, 0, 3, 1.7)),
                           (3, occ.addCylinder(6, 3, -1, 0, 0, 3, 1))])


def tube(occ):
    """Its wall is a volume of its own; the rest of the box is not meshed in the tests."""
    outer = occ.addCylinder(0, 0, 0, 0, 0, 3, 1)
    occ.cut([(3, outer)], [(3, occ.addCylinder(0, 0, 0, 0, 0, 3, 0.7))])


def on_circle(radius, count, z=0.0, phase=0.1):
    phi = phase + 2 * np.pi * np.arange(count) / count
    return np.column_stack((radius * np.cos(phi), radius * np.sin(phi), np.full(count, z)))


def lines_through_the_plate():
    at = np.random.default_rng(3).uniform(1, 5, (10, 2))
    return [((x, y, 0), (x, y, 1)) for x, y in at]


def lines_through_the_wedge():
    """At right angles to the middle plane, where the limit 1 leaves the gap to rule."""
    lines = []
    for x in np.linspace(2, 8, 9):
        half = x * math.sin(DEGREES_10 / 2)
        foot = x * math.cos(DEGREES_10 / 2)
        middle = np.array([foot * math.cos(DEGREES_10 / 2), foot * math.sin(DEGREES_10 / 2), 2.0])
        across = half * np.array([math.sin(DEGREES_10 / 2), -math.cos(DEGREES_10 / 2), 0])
        lines.append((middle + across, middle - across))
    return lines


#: model, size limit, lines across its gap
GAPS = {
    "parallel plates": (plate, 2.0, lines_through_the_plate),
    "10 degree wedge": (wedge, 1.0, lines_through_the_wedge),
    "concentric spheres": (shell, 2.0, lambda: list(zip(
        np.roll(on_circle(1.5, 12), 1, axis=1), np.roll(on_circle(2, 12), 1, axis=1)))),
    "hole near the rim": (plate_with_holes, 2.0, lambda: [
        ((0, 3, z), (0.3, 3, z)) for z in np.linspace(0.1, 0.9, 9)]),
    "tube": (tube, 2.0, lambda: list(zip(on_circle(0.7, 12, 1.5), on_circle(1, 12, 1.5)))),
}


@pytest.mark.parametrize("model", sorted(GAPS))
def test_the_mesh_has_the_cells_that_were_asked_for(model):
    make, limit, lines = GAPS[model]
    volume = volume_of(make)
    field = proximity_field([volume], [volume], size_limit=limit, how={"calibrate": True})
    field.generate(3)
    counts = [cells_along([volume], *line) for line in lines()]
    assert np.mean(counts) == pytest.approx(CELLS, rel=0.1), counts
    assert min(counts) >= 0.8 * CELLS and max(counts) <= 1.2 * CELLS, counts


@pytest.mark.parametrize("cells", [2.5, 5, 8])
def test_any_number_of_cells(cells):
    volume = volume_of(plate)
    field = proximity_field([volume], [volume], cells, how={"calibrate": True})
    field.generate(3)
    counts = [cells_along([volume], *line) for line in lines_through_the_plate()]
    assert np.mean(counts) == pytest.approx(cells, rel=0.1), counts


def test_cells_between_edges_of_a_plane_surface():
    models.start("plane plate")
    occ = gmsh.model.occ
    occ.cut([(2, occ.addRectangle(0, 0, 0, 8, 6))], [(2, occ.addDisk(2, 3, 0, 1.7, 1.7))])
    occ.synchronize()
    face = gmsh.model.getEntities(2)[0]
    field = proximity_field([face], [face], 5)
    np.testing.assert_allclose(field.exact_size(*face, [[0, 3, 0], [0.3, 3, 0]]),
                               gap_size(0.3, 5, GROWTH), rtol=0.02)
    # Far from the hole, the plate's own width.
    assert field.exact_size(*face, [[8, 3, 0]])[0] > 3 * gap_size(0.3, 5, GROWTH)
    field.generate(2)
    counts = []
    for y in np.linspace(2.8, 3.2, 5):
        x = 2 - math.sqrt(1.7**2 - (y - 3)**2)
        counts.append(cells_along([face], (0, y, 0), (x, y, 0)))
    assert min(counts) >= 4 and max(counts) <= 6, counts


# ==== Sizes on the walls


def test_walls_of_parallel_plates():
    for turned in (False, True):
        models.start("plate")
        occ = gmsh.model.occ
        box = [(3, occ.addBox(0, 0, 0, 6, 6, 1))]
        points = np.array([[3, 3, 0], [1, 4, 1], [3, 3, 0.5], [0, 3, 0.5]])
        if turned:
            occ.rotate(box, 0, 0, 0, 1, 0, 0, 0.7)
            c, s = math.cos(0.7), math.sin(0.7)
            points = points @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]])
        occ.synchronize()
        volume = gmsh.model.getEntities(3)[0]
        field = proximity_field([volume], [volume])
        start = gap_size(1, CELLS, GROWTH)
        np.testing.assert_allclose(field.exact_size(*volume, points),
                                   [start, start, start + 0.5 / 6, start + 0.5 / 6], rtol=1e-3)
        gmsh.model.remove()


def test_gap_of_a_wedge_follows_its_width_and_ends_near_the_tip():
    volume = volume_of(wedge)
    limit = 1.0
    field = proximity_field([volume], [volume], size_limit=limit)
    for x in (2, 4, 7):
        size = field.exact_size(*volume, [[x, 0, 2]])[0]
        assert size == pytest.approx(gap_size(x * math.sin(DEGREES_10), CELLS, GROWTH), rel=0.06)
    # Facets that meet make no gap: closer to the tip than the limit there is none, so the size
    # does not go to nothing.
    smallest = field.exact_size(*volume, [[x, 0, 2] for x in np.linspace(0, 10, 500)]).min()
    assert smallest > 0.6 * gap_size(limit * math.sin(DEGREES_10), CELLS, GROWTH)


def test_contact_without_a_common_node_is_no_gap():
    """A ball that lies on the floor: sizes do not go to nothing where they touch."""
    def ball_on_the_floor(occ):
        occ.cut([(3, occ.addBox(-2, -2, 0, 4, 4, 4))], [(3, occ.addSphere(0, 0, 1, 1))])
    volume = volume_of(ball_on_the_floor)
    field = proximity_field([volume], [volume], min_size=0.02)
    assert field.exact_size(*volume, [[0, 0, 0], [0.3, 0, 0]]).min() >= 0.02 * 0.99


def test_pipe_along_a_spline():
    models.start("pipe")
    occ = gmsh.model.occ
    points = [occ.addPoint(math.cos(t), math.sin(t), 0.3 * t) for t in np.linspace(0, 4, 9)]
    wire = occ.addWire([occ.addSpline(points)])
    disk = [(2, occ.addDisk(1, 0, 0, 0.1, 0.1))]
    occ.rotate(disk, 1, 0, 0, 1, 0, 0, math.pi / 2)
    occ.addPipe(disk, wire)
    occ.remove(disk)
    occ.synchronize()
    volume = gmsh.model.getEntities(3)[0]
    side = next(f for f in models.faces_of(volume[1]) if gmsh.model.getType(*f) != "Plane")
    low, high = gmsh.model.getParametrizationBounds(*side)
    at = np.random.default_rng(2).uniform(low, high, (400, 2))
    walls = np.reshape(gmsh.model.getValue(*side, at.ravel()), (-1, 3))
    field = proximity_field([volume], [volume], size_limit=0.8, between="faces")
    sizes = field.exact_size(*volume, walls)
    # The disk is a little oblique to the spline, so that the pipe is not quite round.
    assert sizes.min() > 0.85 * gap_size(0.2, CELLS, GROWTH)
    assert np.median(sizes) == pytest.approx(gap_size(0.2, CELLS, GROWTH), rel=0.07)


def test_inner_corner_of_a_right_angle_is_no_gap():
    def corner(occ):
        occ.cut([(3, occ.addBox(0, 0, 0, 9, 9, 9))], [(3, occ.addBox(3, 3, -1, 9, 9, 20))])
    volume = volume_of(corner)
    field = proximity_field([volume], [volume], size_limit=5)
    # Across the legs 3 is the gap; towards the inner corner nothing is smaller.
    points = np.random.default_rng(5).uniform(0, 3, (200, 3)) * [1, 1, 3]
    assert field.exact_size(*volume, points).min() >= 0.99 * gap_size(3, CELLS, GROWTH)


def thin_wall_in_a_box():
    """A box with a wall of thickness 0.1 standing in it: (wall, the rest)."""
    models.start("wall in a box")
    occ = gmsh.model.occ
    occ.fragment([(3, occ.addBox(0, 0, 0, 8, 8, 8))], [(3, occ.addBox(4, 2, 2, 0.1, 4, 4))])
    occ.synchronize()
    return sorted(gmsh.model.getEntities(3), key=lambda v: occ.getMass(*v))


def test_thin_wall_seen_from_outside_makes_no_gap():
    wall, rest = thin_wall_in_a_box()
    beside = [[4, 4, 4], [4.1, 4, 4], [4, 3, 5]]
    outside = proximity_field([wall], [rest], size_limit=3)
    # From the wall's rims to the box it is 2, from its faces 3.9 and 4.
    assert outside.exact_size(*rest, beside).min() > gap_size(2, CELLS, GROWTH)
    inside = proximity_field([wall], [wall], size_limit=3)
    np.testing.assert_allclose(inside.exact_size(*wall, beside), gap_size(0.1, CELLS, GROWTH),
                               rtol=0.01)


def test_only_sources_get_sizes_but_all_walls_are_opposite():
    volume = volume_of(plate)
    bottom = next(f for f in models.faces_of(volume[1])
                  if abs(gmsh.model.occ.getCenterOfMass(*f)[2]) < 1e-6)
    field = proximity_field([bottom], [volume])
    start = gap_size(1, CELLS, GROWTH)
    np.testing.assert_allclose(field.exact_size(*volume, [[3, 3, 0], [3, 3, 1]]),
                               [start, start + 1 / 6], rtol=1e-3)


def test_gaps_below_the_smallest_size_are_ignored():
    volume = volume_of(plate_with_holes)
    ligament = [[0, 3, 0.5]]
    free = proximity_field([volume], [volume]).exact_size(*volume, ligament)[0]
    assert free == pytest.approx(gap_size(0.3, CELLS, GROWTH), rel=0.02)
    ignoring = proximity_field([volume], [volume], min_size=0.2)
    # The plate's thickness 1 asks for 0.29, the ligament for less than 0.2 where it is narrow.
    sizes = ignoring.exact_size(*volume, np.random.default_rng(1).uniform(0, 1, (300, 3)) * [8, 6, 1])
    assert sizes.min() >= 0.2 * 0.99


def test_faces_edges_or_both():
    def chamfered(occ):
        box = occ.addBox(0, 0, 0, 5, 5, 5)
        occ.synchronize()
        edge = gmsh.model.getBoundary([(2, 1)], combined=False, oriented=False)[0]
        occ.chamfer([box], [edge[1]], [1], [0.1])
    volume = volume_of(chamfered)
    strip = min(models.faces_of(volume[1]), key=lambda f: gmsh.model.occ.getMass(*f))
    point = [gmsh.model.occ.getCenterOfMass(*strip)]
    width = gmsh.model.occ.getMass(*strip) / 5
    by_edges = gap_size(width, CELLS, GROWTH) + width / 2 / 6
    sizes = {between: proximity_field([volume], [volume], between=between, size_limit=3)
             .exact_size(*volume, point)[0] for between in (None, "faces", "edges", "both")}
    assert sizes[None] == sizes["faces"] > 5 * by_edges
    assert sizes["edges"] == pytest.approx(by_edges, rel=0.02)
    assert sizes["both"] == sizes["edges"]


def test_mesh_on_the_sources_is_used():
    volume = volume_of(shell)
    premesh(models.faces_of(volume[1]), 0.15)
    before = everything_in_the_model()
    field = proximity_field([volume], [volume])
    points = np.concatenate((on_circle(1.5, 20), on_circle(2.0, 20)))
    # The chords of the mesh are within the spheres.
    np.testing.assert_allclose(field.exact_size(*volume, points), gap_size(0.5, CELLS, GROWTH),
                               rtol=0.05)
    assert everything_in_the_model() == before


def test_tube_in_a_box_is_measured_on_each_side():
    models.start("tube in a box")
    occ = gmsh.model.occ
    box = occ.addBox(-3, -3, 0, 6, 6, 3)
    wall = occ.cut([(3, occ.addCylinder(0, 0, 0, 0, 0, 3, 1))],
                   [(3, occ.addCylinder(0, 0, 0, 0, 0, 3, 0.7))])[0]
    occ.fragment([(3, box)], wall)
    occ.synchronize()
    volumes = gmsh.model.getEntities(3)
    wall = min(volumes, key=lambda v: abs(occ.getMass(*v) - 3 * math.pi * (1 - 0.49)))
    inside = min(volumes, key=lambda v: abs(occ.getMass(*v) - 3 * math.pi * 0.49))
    outside = max(volumes, key=lambda v: occ.getMass(*v))
    expected = {wall: (0.85, 0.3, 0.15), inside: (0.0, 1.4, 0.7), outside: (2.0, 2.0, 1.0)}
    for volume, (radius, gap, depth) in expected.items():
        field = proximity_field([volume], [volume])
        size = field.exact_size(*volume, [[radius, 0, 1.5]])[0]
        assert size == pytest.approx(gap_size(gap, CELLS, GROWTH) + depth / 6, rel=0.03), volume


def test_discrete_walls():
    """A box whose faces are one STL, without geometry."""
    volume = models.box()
    premesh(models.faces_of(volume[1]), 0.25)
    from test_curvature import stl_of
    _, discrete = stl_of(lambda occ: occ.addBox(0, 0, 0, 6, 6, 1), 0.5)
    field = proximity_field([discrete], [discrete])
    np.testing.assert_allclose(field.exact_size(*discrete, [[3, 3, 0], [2, 3, 1]]),
                               gap_size(1, CELLS, GROWTH), rtol=0.01)


def test_slit_with_the_volume_on_both_sides():
    """A face embedded near a wall: its gap is that to the wall on that side only."""
    models.start("embedded face")
    occ = gmsh.model.occ
    box = occ.addBox(0, 0, 0, 6, 6, 6)
    sheet = occ.addRectangle(1, 1, 0.5, 4, 4)
    occ.synchronize()
    gmsh.model.mesh.embed(2, [sheet], 3, box)
    field = proximity_field([(2, sheet)], [(3, box)])
    size = field.exact_size(3, box, [[3, 3, 0.5]])[0]
    assert size == pytest.approx(gap_size(0.5, CELLS, GROWTH), rel=0.01)


# ==== Bad input


@pytest.mark.parametrize("values, word", [
    ({"cells": 0}, "cells per gap"), ({"cells": float("nan")}, "cells per gap"),
    ({"min_size": -1}, "smallest size"), ({"size_limit": 0}, "size limit")])
def test_bad_numbers_are_named(values, word):
    volume = models.box()
    with pytest.raises(meshgrow.Error, match="Proximity size function 1: .*" + word):
        proximity_field([volume], [volume], **values)


def test_source_that_bounds_no_attachment_is_named():
    wall, rest = thin_wall_in_a_box()
    far = next(f for f in models.faces_of(rest[1]) if f not in models.faces_of(wall[1]))
    with pytest.raises(meshgrow.Error, match="Surface %d.*bounds an attachment" % far[1]):
        proximity_field([far], [wall])


def test_unknown_word_for_between():
    volume = models.box()
    with pytest.raises(ValueError, match="between"):
        proximity_field([volume], [volume], between="walls")
