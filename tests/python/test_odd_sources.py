"""Imported faces that no CAD program draws: sources and attachments all the same."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from meshes import Log, element_count, snapshots

SEED = 20261125
ALPHA = 0.2 / 1.2  # growth rate 1.2


def discrete_surface(points, triangles, tag=1, first=1):
    """A surface that is its triangles, without curves; also where they fit together badly."""
    gmsh.model.addDiscreteEntity(2, tag)
    nodes = np.arange(first, first + len(points))
    gmsh.model.mesh.addNodes(2, tag, nodes, np.ravel(np.asarray(points, dtype=float)))
    gmsh.model.mesh.addElementsByType(tag, 2, [], nodes[np.asarray(triangles)].ravel())
    return (2, tag)


def book(pages, triangles_a_side=4):
    """Squares that share one edge, the z axis: more than two triangles meet in it."""
    points, triangles = [], []
    n = triangles_a_side
    for angle in np.linspace(0, np.pi, pages):
        first = len(points)
        points += [(r * np.cos(angle), r * np.sin(angle), z)
                   for r in np.linspace(0, 1, n + 1) for z in np.linspace(0, 1, n + 1)]
        for i in range(n):
            for j in range(n):
                a, b = first + i * (n + 1) + j, first + (i + 1) * (n + 1) + j
                triangles += [(a, b, a + 1), (b, b + 1, a + 1)]
    return points, triangles


def crossing():
    """Two squares that go through each other without common nodes."""
    points, triangles = book(1)
    other = [(z, 0.5 - y, x - 0.5 + 0.01) for x, y, z in np.asarray(points) - (0, 0.5, 0)]
    return points + other, triangles + [tuple(np.array(t) + len(points)) for t in triangles]


def flipped(shape, every):
    points, triangles = shape
    return points, [t[::-1] if i % every == 0 else t for i, t in enumerate(triangles)]


SHAPES = {"non-manifold": book(3), "self-intersecting": crossing(),
          "inside-out": flipped(book(2), 1), "half inside-out": flipped(book(2), 2)}


def volume_around(side=4.0):
    volume = (3, gmsh.model.occ.addBox(-side / 2, -side / 2, -side / 2, side, side, side))
    gmsh.model.occ.synchronize()
    return volume


def sizes_by_hand(shape, points, limit):
    """min over triangles of mean edge length + alpha * distance, by sampling each finely."""
    corners = np.asarray(shape[0], dtype=float)[np.asarray(shape[1])]
    starts = np.mean([np.linalg.norm(corners[:, i] - corners[:, i - 1], axis=1)
                      for i in range(3)], axis=0)
    steps = [(i / 12, j / 12) for i in range(13) for j in range(13 - i)]
    result = np.full(len(points), limit)
    for corner, start in zip(corners, starts):
        on = [corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0])
              for u, v in steps]
        distance = np.min([np.linalg.norm(points - p, axis=1) for p in on], axis=0)
        result = np.minimum(result, start + ALPHA * distance)
    return result


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
@pytest.mark.parametrize("kind", ["mesh", "fixed", "curvature", "proximity"])
def test_odd_faces_are_sources(shape, kind):
    models.start("odd")
    volume = volume_around()
    source = discrete_surface(*shape, tag=100, first=1000)
    before = snapshots([source])
    field = meshgrow.SizeField(evaluator="grid")
    if kind == "mesh":
        field.add_mesh([source], [volume], 1.2, 0.8)
    elif kind == "fixed":
        field.add_fixed([source], [volume], 0.2, 1.2, 0.8)
    elif kind == "curvature":
        field.add_curvature([source], [volume], growth_rate=1.2, size_limit=0.8, min_size=0.05)
    else:
        gmsh.model.mesh.embed(2, [source[1]], 3, volume[1])
        field = meshgrow.SizeField(evaluator="grid")
        field.add_proximity([source], [volume], growth_rate=1.2, size_limit=0.8, min_size=0.05)
    points = np.random.default_rng(SEED).uniform(-2, 2, (300, 3))
    exact, sizes = field.exact_size(*volume, points), field.size(*volume, points)
    assert (exact > 0).all() and (exact <= 0.8).all(), "seed %d" % SEED
    assert (sizes <= 1.05 * exact + 1e-9).all(), "seed %d" % SEED
    if kind == "mesh":
        by_hand = sizes_by_hand(shape, points, 0.8)
        assert np.abs(exact - by_hand).max() < 0.01, "seed %d" % SEED
    assert snapshots(before) == before


@pytest.mark.parametrize("every", [1, 2, 3])
@pytest.mark.parametrize("kind", ["mesh", "curvature"])
def test_the_side_that_faces_look_to_is_of_no_concern(every, kind):
    points = np.random.default_rng(SEED).uniform(-2, 2, (200, 3))
    answers = []
    for shape in (book(2), flipped(book(2), every)):
        models.start("oriented")
        volume = volume_around()
        source = discrete_surface(*shape, tag=100, first=1000)
        field = meshgrow.SizeField()
        if kind == "mesh":
            field.add_mesh([source], [volume], 1.2, 0.8)
        else:
            field.add_curvature([source], [volume], growth_rate=1.2, size_limit=0.8, min_size=0.05)
        answers.append(field.exact_size(*volume, points))
    assert np.allclose(*answers, rtol=1e-9), "seed %d" % SEED


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_odd_faces_are_attached_and_kept(shape):
    models.start("attached")
    face = discrete_surface(*shape)
    gmsh.model.addDiscreteEntity(0, 7)
    gmsh.model.setCoordinates(7, 0, 0, 0)
    gmsh.model.mesh.addNodes(0, 7, [7000], [0, 0, 0])
    field = meshgrow.SizeField()
    field.add_fixed([(0, 7)], [face], 0.05, 1.2, 0.8)
    assert field.size(*face, [[0, 0, 0.3]])[0] == pytest.approx(0.05 + 0.3 * ALPHA, rel=0.05)
    before = snapshots([face])
    field.generate(2)
    assert snapshots(before) == before


def cube(inward=False):
    points = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return flipped((points, triangles), 1) if inward else (points, triangles)


@pytest.mark.parametrize("inward", [False, True])
def test_a_volume_within_inside_out_faces_is_meshed(inward):
    models.start("inside out")
    face = discrete_surface(*cube(inward))
    volume = (3, gmsh.model.geo.addVolume([gmsh.model.geo.addSurfaceLoop([face[1]])]))
    gmsh.model.geo.synchronize()
    before = snapshots([face])
    field = meshgrow.SizeField()
    field.add_fixed([face], [volume], 0.3, 1.2, 0.5)
    field.generate(3)
    assert snapshots(before) == before
    assert element_count(volume) >= 5


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_a_node_that_is_no_number_is_left_out_and_warned_of(bad):
    models.start("no number")
    volume = volume_around()
    points, triangles = book(2)
    source = discrete_surface(points + [(bad, 0, 0)], triangles + [(0, 1, len(points))],
                              tag=100, first=1000)
    field = meshgrow.SizeField()
    with Log() as log:
        field.add_mesh([source], [volume], 1.2, 0.8)
        at = field.exact_size(*volume, [[0.5, 0.5, 0.5]])[0]
    told = [w for w in log.warnings if "Surface 100" in w]
    assert len(told) == 1 and "1 elements" in told[0] and "no finite coordinates" in told[0]
    assert at == pytest.approx(sizes_by_hand((points, triangles),
                                             np.array([[0.5, 0.5, 0.5]]), 0.8)[0], abs=0.01)


def test_one_facet_and_none():
    models.start("one facet")
    volume = volume_around()
    one = discrete_surface([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], 100, 1000)
    gmsh.model.addDiscreteEntity(2, 101)
    field = meshgrow.SizeField()
    field.add_mesh([one], [volume], 1.2, 2.0)
    field.add_mesh([(2, 101)], [volume], 1.2, 0.01)  # without elements, hence without effect
    with Log() as log:
        size = field.size(*volume, [[0.1, 0.1, 1.0]])[0]
    assert size == pytest.approx((2 + 2**0.5) / 3 + ALPHA, rel=0.05)
    assert any("Surface 101 has no mesh" in w for w in log.warnings)


def test_tags_near_the_largest_that_there_can_be():
    """Entities and elements up to 2^31 - 1, nodes beyond 2^40 where Gmsh takes them."""
    models.start("tags")
    largest = 2**31 - 1
    points, triangles = book(2)
    node, element = 2**40 + 5, largest - 500
    if gmsh.option.getString("General.Version").startswith("4.8"):
        node = element = 10**6  # it keeps a table of all tags up to the largest
    source = (2, largest - 1)
    gmsh.model.addDiscreteEntity(*source)
    nodes = node + np.arange(len(points))
    gmsh.model.mesh.addNodes(2, source[1], nodes, np.ravel(points))
    elements = element + np.arange(len(triangles))
    gmsh.model.mesh.addElementsByType(source[1], 2, elements,
                                      nodes[np.asarray(triangles)].ravel())
    attached = (2, largest)
    gmsh.model.addDiscreteEntity(*attached)
    field = meshgrow.SizeField()
    field.add("mesh source Surface{%d} attach Surface{%d} growth 1.2 limit 0.8"
              % (source[1], attached[1]))
    at = np.array([[0.5, 0.0, 0.5], [0.5, 1.0, 0.5]])
    assert field.exact_size(*attached, at) == pytest.approx(
        sizes_by_hand((points, triangles), at, 0.8), abs=0.01)
    told = field.probe(*attached, at[0])
    assert tuple(told["facet"]["entity"]) == source
    assert element <= told["facet"]["element"] < element + len(triangles)
    for tag in (2**31, 2**40, 10**30):
        with pytest.raises(meshgrow.Error, match="number|Surface|tag"):
            field.add("fixed source Surface{%d} attach Surface{%d} size 1 growth 1.2 limit 2"
                      % (tag, attached[1]))


def test_a_mesh_file_whose_only_groups_are_surfaces_bounds_a_volume(tmp_path):
    """Gmsh saves no elements of its curves then."""
    volume = models.box()
    faces = sorted(gmsh.model.getBoundary([volume], oriented=False))
    gmsh.model.addPhysicalGroup(2, [tag for _, tag in faces])
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.3)
    gmsh.model.mesh.generate(2)
    gmsh.model.removeEntities([volume])  # or the file would bring it along, empty
    path = str(tmp_path / "faces.msh")
    gmsh.write(path)
    models.start("of the file")
    gmsh.merge(path)
    faces = gmsh.model.getEntities(2)
    curves = gmsh.model.getEntities(1)
    assert len(faces) == 6 and len(curves) == 12 and element_count(*curves) == 0
    volume = (3, gmsh.model.geo.addVolume([gmsh.model.geo.addSurfaceLoop([t for _, t in faces])]))
    gmsh.model.geo.synchronize()
    before = snapshots(faces)
    field = meshgrow.SizeField()
    field.add_mesh(faces, [volume], 1.2, 0.5)
    assert [p["entities"] for p in field.plan(3)] == [[volume]]
    field.generate(3)
    assert snapshots(before) == before
    assert element_count(volume) > 10
