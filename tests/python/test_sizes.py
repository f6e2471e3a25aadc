"""Sizes of the field against the definition, evaluated by brute force."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
import reference
from meshes import boundary, closure, corners, options, premesh, quad_corners, random_points

GROWTH = 1.3
LIMIT = 0.6
EXACT = 1e-5  # rounding of the fast path, DESIGN.md, section 2


def field_of(sources, attach, growth_rate=GROWTH, size_limit=LIMIT, quad_size="triangles", **how):
    field = meshgrow.SizeField(**how)
    field.add_mesh(sources, attach, growth_rate, size_limit, quad_size)
    return field


def premeshed_sphere(order=1):
    model = models.sphere_in_box(side=4.0)
    premesh([model.sphere], lambda x, y, z: 0.2 + 0.1 * z)
    if order > 1:
        gmsh.model.mesh.setOrder(order)
    return model


def points_around(entity_box=2.0, count=400):
    """Some anywhere in the box, some very near the unit sphere."""
    near = random_points(count // 4, -1, 1, seed=2)
    near *= (1 + 1e-3 * np.arange(len(near))[:, None] / len(near)) / np.linalg.norm(
        near, axis=1)[:, None]
    return np.concatenate((random_points(count, -entity_box, entity_box), near))


def assert_exact(field, entity, facets, points, growth_rate=GROWTH, limit=LIMIT):
    expected = reference.sizes(facets, points, growth_rate, limit)
    assert expected.min() < 0.8 * expected.max(), "the points must see different sizes"
    np.testing.assert_allclose(field.exact_size(*entity, points), expected, rtol=EXACT)


# ==== Exact sizes ====


def test_sizes_grow_from_a_premeshed_surface():
    model = premeshed_sphere()
    field = field_of([model.sphere], [model.outer])
    facets = [reference.triangles(corners(model.sphere, "Triangle"))]
    assert_exact(field, model.outer, facets, points_around())


def test_sizes_without_growth_are_the_smallest_start_size():
    model = premeshed_sphere()
    field = field_of([model.sphere], [model.outer], growth_rate=1.0)
    start = reference.triangles(corners(model.sphere, "Triangle")).start
    sizes = field.exact_size(*model.outer, points_around())
    np.testing.assert_allclose(sizes, start.min(), rtol=EXACT)


@pytest.mark.parametrize("order", [2, 3])
def test_elements_of_higher_order_are_sized_by_their_corners(order):
    model = premeshed_sphere(order)
    assert gmsh.model.mesh.getElementProperties(
        gmsh.model.mesh.getElementTypes(*model.sphere)[0])[2] == order
    field = field_of([model.sphere], [model.outer])
    facets = [reference.triangles(corners(model.sphere, "Triangle"))]
    assert_exact(field, model.outer, facets, points_around())


def premeshed_curve(order=1):
    volume = models.single(lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 2, 1))
    circle = next(c for c in gmsh.model.getEntities(1)
                  if gmsh.model.getType(*c) == "Circle")
    premesh([circle], lambda x, y, z: 0.1 + 0.05 * x)
    if order > 1:
        gmsh.model.mesh.setOrder(order)
    return volume, circle


@pytest.mark.parametrize("order", [1, 2, 3])
def test_sizes_grow_from_a_premeshed_curve(order):
    volume, circle = premeshed_curve(order)
    field = field_of([circle], [volume])
    facets = [reference.segments(corners(circle, "Line"))]
    assert_exact(field, volume, facets, random_points(400, [-1, -1, 0], [1, 1, 2]))


def premeshed_quads(order=1):
    volume = models.box(1.0)
    face = models.faces_of(volume[1])[0]
    with options(Mesh_RecombineAll=1):
        premesh([face], lambda x, y, z: 0.12 + 0.1 * y)
    if order > 1:
        gmsh.model.mesh.setOrder(order)
    quads = quad_corners(face)
    assert len(quads) > 20
    return volume, face, quads


QUAD_RULES = {"triangles": reference.quads_as_triangles, "sides": reference.quads_by_sides}


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("quad_size", sorted(QUAD_RULES))
def test_sizes_grow_from_quadrilaterals_by_the_rule_asked_for(quad_size, order):
    volume, face, quads = premeshed_quads(order)
    field = field_of([face], [volume], quad_size=quad_size)
    facets = [QUAD_RULES[quad_size](quads)]
    left_over = corners(face, "Triangle")
    if len(left_over):
        facets.append(reference.triangles(left_over))
    assert_exact(field, volume, facets, random_points(400, 0, 1))


def test_diagonals_make_quadrilaterals_larger_than_their_sides():
    """A square of side 1 is sized 1.138 with its diagonal, 1 by its sides."""
    volume, face, quads = premeshed_quads()
    centres = quads.mean(axis=1)
    by_rule = [field_of([face], [volume], 1.5, quad_size=rule).exact_size(*volume, centres)
               for rule in ("triangles", "sides")]
    assert 1.05 < np.median(by_rule[0] / by_rule[1]) < 1.15


def test_several_sources_of_one_function_and_several_functions_give_the_smallest_size():
    volume = models.box(1.0)
    faces = models.faces_of(volume[1])
    curve = boundary([faces[0]])[0]
    premesh(faces[:2], 0.3)
    field = meshgrow.SizeField()
    field.add_mesh(faces[:2], [volume], 1.4, 0.7)
    field.add_mesh([curve], [volume], 1.1, 0.5)
    points = random_points(300, 0, 1)
    expected = np.minimum(
        reference.sizes([reference.triangles(corners(f, "Triangle")) for f in faces[:2]],
                        points, 1.4, 0.7),
        reference.sizes([reference.segments(corners(curve, "Line"))], points, 1.1, 0.5))
    np.testing.assert_allclose(field.exact_size(*volume, points), expected, rtol=EXACT)


def test_functions_act_only_on_their_own_attachments():
    model = models.two_boxes()
    at_x = {round(gmsh.model.occ.getCenterOfMass(*f)[0], 3): f for f in gmsh.model.getEntities(2)}
    fine, coarse = at_x[0.0], at_x[2.0]
    premesh([fine, coarse], lambda x, y, z: 0.1 if x < 0.5 else 0.4)
    field = meshgrow.SizeField()
    field.add_mesh([fine], [model.left], 1.2, 3.0)
    field.add_mesh([coarse], [model.right], 1.2, 3.0)
    points = random_points(100, [0, 0, 0], [2, 1, 1])
    by_fine = reference.sizes([reference.triangles(corners(fine, "Triangle"))], points, 1.2, 3)
    by_coarse = reference.sizes([reference.triangles(corners(coarse, "Triangle"))], points, 1.2, 3)
    exact = field.exact_size
    np.testing.assert_allclose(exact(*model.left, points), by_fine, rtol=EXACT)
    np.testing.assert_allclose(exact(*model.right, points), by_coarse, rtol=EXACT)
    np.testing.assert_allclose(exact(*model.between, points), np.minimum(by_fine, by_coarse),
                               rtol=EXACT)


# ==== The grid ====


@pytest.mark.parametrize("tolerance", [0.02, 0.05, 0.2])
def test_grid_is_never_coarser_than_its_tolerance_and_hardly_finer(tolerance):
    model = premeshed_sphere()
    field = field_of([model.sphere], [model.outer], tolerance=tolerance, evaluator="grid")
    points = points_around(count=4000)
    grid, exact = field.size(*model.outer, points), field.exact_size(*model.outer, points)
    assert np.all(grid <= (1 + tolerance) * exact * (1 + EXACT))
    assert np.quantile((exact - grid) / exact, 0.999) <= 2 * tolerance
    assert np.any(grid != exact), "nothing was interpolated"


def test_exact_evaluator_has_no_grid():
    model = premeshed_sphere()
    field = field_of([model.sphere], [model.outer], evaluator="exact")
    points = points_around()
    assert np.array_equal(field.size(*model.outer, points),
                          field.exact_size(*model.outer, points))
    assert all(group["grid"] is None for group in field.statistics()["groups"])


def test_number_of_threads_does_not_change_a_size():
    model = premeshed_sphere()
    points = points_around()
    by_threads = [field_of([model.sphere], [model.outer], threads=n).size(*model.outer, points)
                  for n in (1, 2, 3)]
    assert np.array_equal(by_threads[0], by_threads[1])
    assert np.array_equal(by_threads[0], by_threads[2])


# ==== Where a function acts ====


def test_size_is_infinite_on_entities_that_nothing_acts_on():
    model = premeshed_sphere()
    field = field_of([model.sphere], [model.walls[0]])
    point = [[0.5, 0.5, 0.5]]
    for entity in (model.inner, model.outer, model.sphere, model.walls[1]):
        assert field.size(*entity, point)[0] == np.inf
        assert field.exact_size(*entity, point)[0] == np.inf
    assert np.isfinite(field.size(*model.walls[0], point)[0])


def test_lower_topology_of_an_attachment_is_acted_on():
    model = premeshed_sphere()
    field = field_of([model.sphere], [model.outer])
    point = [[1.5, 1.4, 1.3]]
    size = field.exact_size(*model.outer, point)[0]
    for entity in closure([model.outer]):
        assert field.exact_size(*entity, point)[0] == size, entity
    assert field.exact_size(*model.inner, point)[0] == np.inf


def square_with_embedded(dim):
    model = models.square()
    occ = gmsh.model.occ
    if dim == 0:
        tag = occ.addPoint(0.4, 0.6, 0)
    else:
        tag = occ.addLine(occ.addPoint(0.3, 0.3, 0), occ.addPoint(0.7, 0.6, 0))
    occ.synchronize()
    gmsh.model.mesh.embed(dim, [tag], *model.face)
    return model, (dim, tag)


@pytest.mark.parametrize("dim", [0, 1])
def test_entities_embedded_in_an_attachment_are_acted_on(dim):
    model, embedded = square_with_embedded(dim)
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.1, 1.2, 0.5)
    for entity in closure([embedded]):
        assert field.exact_size(*entity, [[0.5, 0.0, 0.0]])[0] == pytest.approx(0.1)


def test_curve_embedded_in_a_face_of_an_attached_volume_is_acted_on():
    volume = models.box(1.0)
    face = next(f for f in models.faces_of(volume[1])
                if gmsh.model.occ.getCenterOfMass(*f)[2] == pytest.approx(0))
    occ = gmsh.model.occ
    line = occ.addLine(occ.addPoint(0.3, 0.3, 0), occ.addPoint(0.7, 0.6, 0))
    occ.synchronize()
    gmsh.model.mesh.embed(1, [line], *face)
    field = meshgrow.SizeField()
    field.add_fixed([boundary([face])[0]], [volume], 0.1, 1.2, 0.5)
    assert np.isfinite(field.size(1, line, [[0.5, 0.5, 0.0]])[0])


def test_embedded_curve_gets_the_sizes_of_the_field():
    counts = []
    for size in (0.1, 0.05):
        model, embedded = square_with_embedded(1)
        field = meshgrow.SizeField()
        field.add_fixed([embedded], [model.face], size, 1.2, 0.5)
        field.generate(2)
        counts.append(len(gmsh.model.mesh.getElements(*embedded)[1][0]))
    assert counts[0] == pytest.approx(0.5 / 0.1, abs=1)
    assert counts[1] == pytest.approx(0.5 / 0.05, abs=1)


def test_a_point_that_is_not_finite_has_no_size():
    model = premeshed_sphere()
    field = field_of([model.sphere], [model.outer])
    sizes = field.size(*model.outer, [[np.nan, 0, 0], [0, np.inf, 0], [1.5, 0, 0]])
    assert list(np.isfinite(sizes)) == [False, False, True]


def test_points_far_outside_the_model_get_a_size_within_the_promise():
    model = premeshed_sphere()
    field = field_of([model.sphere], [model.outer], size_limit=50.0)
    points = random_points(100, -60, 60)
    assert np.all(field.size(*model.outer, points)
                  <= 1.05 * field.exact_size(*model.outer, points) * (1 + EXACT))


# ==== Sources that change ====


def test_refresh_reads_the_sources_as_they_are_meshed_now():
    model = premeshed_sphere()
    field = field_of([model.sphere], [model.outer])
    points = points_around()
    field.refresh()
    gmsh.model.mesh.clear()
    premesh([model.sphere], 0.1)
    field.refresh()
    assert_exact(field, model.outer, [reference.triangles(corners(model.sphere, "Triangle"))],
                 points)


def test_a_function_added_after_sizes_were_asked_for_is_in_force():
    model = premeshed_sphere()
    field = field_of([model.sphere], [model.outer])
    point = [[1.8, 1.8, 1.8]]
    before = field.size(*model.outer, point)[0]
    field.add_fixed([model.walls[0]], [model.outer], 0.01, 1.0, 1.0)
    assert before > 0.1
    assert field.size(*model.outer, point)[0] == pytest.approx(0.01)


@pytest.mark.parametrize("dim", [2, 3])
def test_after_generate_sizes_are_those_of_the_sources_as_meshed(dim):
    """The source is meshed by generate itself, in its last pass for dim 2."""
    model = models.box_in_box_of(lambda occ: occ.addSphere(0, 0, 0, 1))
    with options(Mesh_MeshSizeMax=0.3):
        field = field_of(model.faces, [model.volume])
        field.generate(dim)
    facets = [reference.triangles(corners(model.faces[0], "Triangle"))]
    points = np.concatenate((points_around(), random_points(100, -0.5, 0.5)))
    assert_exact(field, model.volume, facets, points)
    assert np.all(field.size(*model.volume, points)
                  <= 1.05 * field.exact_size(*model.volume, points) * (1 + EXACT))


def test_after_generate_of_curves_sizes_are_those_of_a_curve_source():
    model = models.square()
    with options(Mesh_MeshSizeMax=0.1):
        field = field_of([model.bottom], [model.face], 1.2, 0.5)
        field.generate(1)
    facets = [reference.segments(corners(model.bottom, "Line"))]
    points = random_points(100, [0, 0, 0], [1, 1, 0])
    assert_exact(field, model.face, facets, points, 1.2, 0.5)


# ==== Fixed size functions: sources without a mesh ====


def fixed(source, attach, size=0.1, growth_rate=1.25, size_limit=5.0):
    field = meshgrow.SizeField()
    field.add_fixed([source], [attach], size, growth_rate, size_limit)
    return field


def closed_form(distance, size=0.1, growth_rate=1.25, size_limit=5.0):
    return np.minimum(size_limit, size + (1 - 1 / growth_rate) * distance)


def test_fixed_size_grows_from_a_point():
    volume = models.box(1.0)
    corner = gmsh.model.getEntities(0)[0]
    at = np.array(gmsh.model.getValue(*corner, []))
    points = random_points(200, 0, 1)
    expected = closed_form(np.linalg.norm(points - at, axis=1))
    np.testing.assert_allclose(fixed(corner, volume).exact_size(*volume, points), expected,
                               rtol=EXACT)


def test_fixed_size_grows_from_a_straight_curve():
    volume = models.box(1.0)
    curve = next(c for c in gmsh.model.getEntities(1)
                 if np.allclose(gmsh.model.occ.getCenterOfMass(*c), (0.5, 0, 0)))
    points = random_points(200, 0, 1)
    expected = closed_form(np.hypot(points[:, 1], points[:, 2]))
    np.testing.assert_allclose(fixed(curve, volume).exact_size(*volume, points), expected,
                               rtol=0.05)


def test_fixed_size_grows_from_a_plane_surface():
    volume = models.box(1.0)
    face = next(f for f in models.faces_of(volume[1])
                if np.allclose(gmsh.model.occ.getCenterOfMass(*f), (0.5, 0.5, 0)))
    points = random_points(200, 0, 1)
    np.testing.assert_allclose(fixed(face, volume).exact_size(*volume, points),
                               closed_form(points[:, 2]), rtol=0.05)


@pytest.mark.parametrize("size", [0.02, 0.1, 0.5])
def test_fixed_size_grows_from_a_sphere(size):
    model = models.box_in_box_of(lambda occ: occ.addSphere(0, 0, 0, 1))
    points = points_around()
    distance = np.abs(np.linalg.norm(points, axis=1) - 1)
    sizes = fixed(model.faces[0], model.volume, size).exact_size(*model.volume, points)
    np.testing.assert_allclose(sizes, closed_form(distance, size), rtol=0.05)


def test_fixed_size_grows_from_a_circle():
    volume = models.single(lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 2, 1))
    circle = next(c for c in gmsh.model.getEntities(1)
                  if np.allclose(gmsh.model.occ.getCenterOfMass(*c), (0, 0, 0)))
    points = random_points(200, [-1, -1, 0], [1, 1, 2])
    distance = np.hypot(np.hypot(points[:, 0], points[:, 1]) - 1, points[:, 2])
    np.testing.assert_allclose(fixed(circle, volume, 0.05).exact_size(*volume, points),
                               closed_form(distance, 0.05), rtol=0.05)


def test_fixed_size_grows_from_a_trimmed_surface():
    """A plate with a round hole: in the hole the size grows from its rim."""
    models.start("plate with a hole")
    occ = gmsh.model.occ
    occ.cut([(3, occ.addBox(-1, -1, -1, 2, 2, 1))],
            [(3, occ.addCylinder(0, 0, -2, 0, 0, 3, 0.5))])
    occ.synchronize()
    volume = gmsh.model.getEntities(3)[0]
    top = next(f for f in models.faces_of(volume[1])
               if occ.getCenterOfMass(*f)[2] == pytest.approx(0))
    points = random_points(300, [-0.9, -0.9, 0], [0.9, 0.9, 1])
    from_rim = np.hypot(np.maximum(0.5 - np.hypot(points[:, 0], points[:, 1]), 0), points[:, 2])
    np.testing.assert_allclose(fixed(top, volume).exact_size(*volume, points),
                               closed_form(from_rim), rtol=0.05)


def test_fixed_size_on_a_volume_holds_in_all_of_it_and_grows_outside():
    model = models.sphere_in_box(side=4.0)
    field = meshgrow.SizeField()
    field.add_fixed([model.inner], [model.inner, model.outer], 0.1, 1.25, 5.0)
    inside = random_points(50, -0.5, 0.5)
    np.testing.assert_allclose(field.exact_size(*model.inner, inside), 0.1, rtol=EXACT)
    outside = random_points(200, -2, 2)
    outside = outside[np.linalg.norm(outside, axis=1) > 1]
    np.testing.assert_allclose(field.exact_size(*model.outer, outside),
                               closed_form(np.linalg.norm(outside, axis=1) - 1), rtol=0.05)


@pytest.mark.parametrize("dim", [0, 1, 2, 3])
def test_fixed_size_leaves_nothing_in_the_model(dim):
    model = models.sphere_in_box(side=4.0)
    sources = {0: gmsh.model.getEntities(0)[0], 1: gmsh.model.getEntities(1)[0], 2: model.sphere,
               3: model.inner}
    before = gmsh.model.getEntities()
    name = gmsh.model.getCurrent()
    field = fixed(sources[dim], model.outer)
    field.size(*model.outer, [[1.5, 1.5, 1.5]])
    field.exact_size(*model.outer, [[1.5, 1.5, 1.5]])
    field.summary()
    assert len(gmsh.model.mesh.getNodes()[0]) == 0
    assert all(len(block) == 0 for block in gmsh.model.mesh.getElements()[1])
    assert gmsh.model.getEntities() == before
    assert gmsh.model.list().count(name) == 1 and gmsh.model.getCurrent() == name


def test_fixed_size_on_a_premeshed_source_grows_from_its_elements():
    model = premeshed_sphere()
    field = fixed(model.sphere, model.outer, 0.05)
    triangles = reference.triangles(corners(model.sphere, "Triangle"))
    triangles.start[:] = 0.05
    assert_exact(field, model.outer, [triangles], points_around(), 1.25, 5.0)
