"""What has a mesh before field.generate keeps it, and everything else gets one."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from meshes import (closure, corner_tags, element_count, has_elements, node_positions,
                    options, premesh, signed_volumes, snapshot, snapshots)


def mesh_field(sources, attach, growth_rate=1.5, size_limit=1.0, **options_of_field):
    field = meshgrow.SizeField(**options_of_field)
    field.add_mesh(sources, attach, growth_rate, size_limit)
    return field


def assert_kept(before):
    after = snapshots(before)
    for entity, (tags, coordinates, elements) in before.items():
        assert after[entity][0] == tags, "node tags of %s" % (entity,)
        assert after[entity][1] == coordinates, "coordinates of %s" % (entity,)
        assert after[entity][2] == elements, "elements of %s" % (entity,)


def assert_every_node_is_used_once():
    tags = [int(t) for t in gmsh.model.mesh.getNodes()[0]]
    assert len(tags) == len(set(tags))


def discretize_keeping_mesh(volume):
    """The meshed faces of a volume as one discrete surface with a discrete volume, in a model of
    its own: as read from an STL file."""
    positions = node_positions()
    triangles = np.concatenate([corner_tags(f, "Triangle") for f in models.faces_of(volume[1])])
    used = np.unique(triangles)
    models.start("discrete")
    gmsh.model.addDiscreteEntity(2, 1)
    gmsh.model.mesh.addNodes(2, 1, used, positions[used].ravel())
    gmsh.model.mesh.addElementsByType(1, 2, [], triangles.ravel())
    gmsh.model.geo.addSurfaceLoop([1], 1)
    gmsh.model.geo.addVolume([1], 1)
    gmsh.model.geo.synchronize()
    return (2, 1), (3, 1)


SHAPES = {
    "sphere": lambda occ: occ.addSphere(0, 0, 0, 1),
    "torus": lambda occ: occ.addTorus(0, 0, 0, 1, 0.4),
    "cylinder": lambda occ: occ.addCylinder(0, 0, -0.7, 0, 0, 1.4, 0.7),
    "cone": lambda occ: occ.addCone(0, 0, -0.7, 0, 0, 1.4, 0.8, 0),
    "box": lambda occ: occ.addBox(-0.6, -0.6, -0.6, 1.2, 1.2, 1.2),
}


# ==== Line 1: premeshed surfaces and curves ====


@pytest.mark.parametrize("shape", sorted(SHAPES))
def test_premeshed_surfaces_are_kept_and_the_volume_around_is_meshed(shape):
    model = models.box_in_box_of(SHAPES[shape])
    premesh(model.faces, lambda x, y, z: 0.25 + 0.05 * z)
    before = snapshots(closure(model.faces))
    mesh_field(model.faces, [model.volume]).generate(3)
    assert_kept(before)
    assert element_count(model.volume) > 500
    assert_every_node_is_used_once()


def test_premeshed_surface_that_is_no_source_is_kept_as_well():
    model = models.box_in_box_of(SHAPES["sphere"])
    premesh(model.faces + model.walls[:1], 0.3)
    before = snapshots(closure(model.faces + model.walls[:1]))
    mesh_field(model.faces, [model.volume]).generate(3)
    assert_kept(before)
    assert has_elements(model.volume)


def test_parametric_coordinates_of_a_premeshed_surface_are_kept():
    model = models.box_in_box_of(SHAPES["torus"])
    premesh(model.faces, 0.3)
    face = model.faces[0]
    before = np.asarray(gmsh.model.mesh.getNodes(*face)[2])
    mesh_field(model.faces, [model.volume]).generate(3)
    after = np.asarray(gmsh.model.mesh.getNodes(*face)[2])
    assert before.size > 0
    assert np.array_equal(after, before)


def test_premeshed_curves_are_kept_and_the_faces_beside_them_meshed():
    volume = models.box(2.0)
    curves = [e for e in gmsh.model.getEntities(1)][:3]
    premesh(curves, lambda x, y, z: 0.1 + 0.1 * x)
    before = snapshots(closure(curves))
    mesh_field(curves, [volume]).generate(3)
    assert_kept(before)
    assert all(has_elements(e) for e in gmsh.model.getEntities(2))
    assert has_elements(volume)


def test_discrete_surface_is_kept_and_its_volume_meshed():
    volume = models.single(SHAPES["sphere"])
    premesh(models.faces_of(volume[1]), 0.25)
    surface, discrete_volume = discretize_keeping_mesh(volume)
    before = snapshot(surface)
    mesh_field([surface], [discrete_volume]).generate(3)
    assert snapshot(surface) == before
    assert element_count(discrete_volume) > 300


def test_discrete_surface_beside_nothing_else_leaves_other_model_entities_alone():
    volume = models.single(SHAPES["sphere"])
    premesh(models.faces_of(volume[1]), 0.3)
    first_model = gmsh.model.getCurrent()
    before = snapshots(closure([volume]))
    surface, discrete_volume = discretize_keeping_mesh(volume)
    mesh_field([surface], [discrete_volume]).generate(3)
    gmsh.model.setCurrent(first_model)
    assert_kept(before)


# ==== Premeshed volumes ====


def test_premeshed_volume_is_kept_and_its_neighbour_meshed():
    model = models.two_boxes()
    premesh([model.left], 0.2)
    before = snapshots(closure([model.left]))
    mesh_field([model.between], [model.right]).generate(3)
    assert_kept(before)
    assert element_count(model.right) > 100


def test_premeshed_enclosed_volume_is_kept():
    model = models.sphere_in_box(side=4.0)
    premesh([model.inner], 0.3)
    before = snapshots(closure([model.inner]))
    mesh_field([model.sphere], [model.outer]).generate(3)
    assert_kept(before)
    assert element_count(model.outer) > 500


def test_premeshed_enclosing_volume_is_kept():
    model = models.sphere_in_box(side=4.0)
    premesh([model.outer], 0.5)
    gmsh.model.mesh.clear([model.inner])  # Gmsh meshes it along
    assert not has_elements(model.inner)
    before = snapshots(closure([model.outer]))
    mesh_field([model.sphere], [model.inner]).generate(3)
    assert_kept(before)
    assert element_count(model.inner) > 100


# ==== Line 3: higher order ====


def premesh_second_order(faces, size):
    premesh(faces, size)
    gmsh.model.mesh.setOrder(2)


def element_types(entity):
    return [int(t) for t in gmsh.model.mesh.getElementTypes(*entity)]


def test_second_order_premeshed_surface_keeps_its_mid_nodes():
    model = models.box_in_box_of(SHAPES["sphere"])
    premesh_second_order(model.faces, 0.3)
    assert element_types(model.faces[0]) == [9]
    before = snapshots(closure(model.faces))
    mesh_field(model.faces, [model.volume]).generate(3)
    assert_kept(before)
    assert element_types(model.faces[0]) == [9]
    for wall in model.walls:
        assert element_types(wall) == [2]
    assert element_types(model.volume) == [4]


def test_second_order_premeshed_surface_keeps_its_mid_nodes_beside_unattached_volumes():
    model = models.sphere_in_box(side=4.0)
    premesh_second_order([model.sphere], 0.35)
    before = snapshots(closure([model.sphere]))
    mesh_field([model.sphere], [model.outer]).generate(3)
    assert_kept(before)
    assert has_elements(model.inner) and has_elements(model.outer)


def element_nodes(entity):
    return {int(n) for block in gmsh.model.mesh.getElements(*entity)[2] for n in block}


def test_element_order_of_the_user_holds_at_the_end():
    model = models.box_in_box_of(SHAPES["box"])
    premesh(model.faces, 0.4)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    mesh_field(model.faces, [model.volume]).generate(3)
    assert element_types(model.volume) == [11]
    for wall in model.walls:
        assert element_types(wall) == [9]
        assert element_nodes(wall) <= element_nodes(model.volume)
    assert element_types(model.faces[0]) == [9]
    assert gmsh.option.getNumber("Mesh.ElementOrder") == 2


def test_element_order_of_the_user_keeps_the_corner_nodes_of_what_was_premeshed():
    model = models.box_in_box_of(SHAPES["sphere"])
    premesh(model.faces, 0.35)
    before = corner_tags(model.faces[0], "Triangle")
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    mesh_field(model.faces, [model.volume]).generate(3)
    assert np.array_equal(corner_tags(model.faces[0], "Triangle"), before)


def test_second_order_premesh_in_a_second_order_mesh_is_kept_and_shares_its_mid_nodes():
    model = models.box_in_box_of(SHAPES["box"])
    premesh_second_order(model.faces, 0.4)
    before = snapshots(closure(model.faces))
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    mesh_field(model.faces, [model.volume]).generate(3)
    assert_kept(before)
    assert element_types(model.volume) == [11]
    for face in model.faces + model.walls:
        assert element_nodes(face) <= element_nodes(model.volume)


# ==== Line 5: options and visibility ====


TOUCHED = {"Mesh.MeshOnlyVisible": 0, "Mesh.MeshOnlyEmpty": 1, "Mesh.Renumber": 1,
           "Mesh.ElementOrder": 1, "Mesh.MeshSizeExtendFromBoundary": 1}
OTHERS = {"Mesh.MeshOnlyVisible": 0, "Mesh.MeshOnlyEmpty": 0, "Mesh.Renumber": 0,
          "Mesh.ElementOrder": 2, "Mesh.MeshSizeExtendFromBoundary": 0}


def set_options(values):
    for name, value in values.items():
        gmsh.option.setNumber(name, value)


def get_options(names):
    return {name: gmsh.option.getNumber(name) for name in names}


def hide_every_third():
    for number, entity in enumerate(gmsh.model.getEntities()):
        gmsh.model.setVisibility([entity], 0 if number % 3 == 0 else 1)


def visibilities():
    return {e: gmsh.model.getVisibility(*e) for e in gmsh.model.getEntities()}


@pytest.mark.parametrize("values", [TOUCHED, OTHERS], ids=["defaults", "others"])
def test_options_are_restored_after_meshing(values):
    model = models.box_in_box_of(SHAPES["box"])
    premesh(model.faces, 0.4)
    set_options(values)
    mesh_field(model.faces, [model.volume]).generate(3)
    assert get_options(values) == values


def test_visibility_is_restored_after_meshing_and_hidden_entities_are_meshed():
    model = models.box_in_box_of(SHAPES["box"])
    premesh(model.faces, 0.4)
    hide_every_third()
    before = visibilities()
    assert set(before.values()) == {0, 1}
    mesh_field(model.faces, [model.volume]).generate(3)
    assert visibilities() == before
    assert all(has_elements(e) for e in gmsh.model.getEntities(2))


def model_that_cannot_be_meshed():
    """A box around a discrete surface mesh that pokes through the box's own face."""
    models.start("broken")
    nodes = np.array([[.2, .2, .5], [.8, .2, .5], [.5, .8, .5], [.5, .4, 1.7]])
    gmsh.model.addDiscreteEntity(2, 1)
    gmsh.model.mesh.addNodes(2, 1, [1, 2, 3, 4], nodes.ravel())
    gmsh.model.mesh.addElementsByType(1, 2, [], [1, 3, 2, 1, 2, 4, 2, 3, 4, 3, 1, 4])
    geo = gmsh.model.geo
    base = [geo.addPoint(x, y, 0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    lines = [geo.addLine(base[i], base[(i + 1) % 4]) for i in range(4)]
    bottom = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    extruded = geo.extrude([(2, bottom)], 0, 0, 1)
    geo.remove([e for e in extruded if e[0] == 3])
    geo.synchronize()
    sides = [e for e in extruded if e[0] == 2]
    loop = geo.addSurfaceLoop([bottom] + [tag for _, tag in sides])
    hole = geo.addSurfaceLoop([1])
    volume = geo.addVolume([loop, hole])
    geo.synchronize()
    return (2, 1), (3, volume)


@pytest.mark.parametrize("values", [TOUCHED, OTHERS], ids=["defaults", "others"])
def test_options_and_visibility_are_as_before_when_gmsh_fails(values):
    surface, volume = model_that_cannot_be_meshed()
    set_options(values)
    hide_every_third()
    shown = visibilities()
    field = mesh_field([surface], [volume], 1.3, 0.4)
    with pytest.raises(meshgrow.Error, match="Volume %d" % volume[1]):
        field.generate(3)
    assert get_options(values) == values
    assert visibilities() == shown


def test_premesh_is_kept_when_gmsh_fails():
    """Gmsh moves the nodes of the boundary a little when it cannot mesh a volume."""
    surface, volume = model_that_cannot_be_meshed()
    before = snapshots([surface])
    field = mesh_field([surface], [volume], 1.3, 0.4)
    with pytest.raises(meshgrow.Error):
        field.generate(3)
    assert_kept(before)


def test_second_order_premesh_is_kept_when_gmsh_fails():
    surface, volume = model_that_cannot_be_meshed()
    curve = next(e for e in gmsh.model.getEntities(1))
    premesh([curve], 0.2)
    gmsh.model.mesh.setOrder(2)
    before = snapshots([surface, curve])
    assert element_types(curve) == [8]
    field = mesh_field([surface], [volume], 1.3, 0.4)
    with pytest.raises(meshgrow.Error):
        field.generate(3)
    assert_kept(before)


def test_a_registered_field_is_still_the_size_callback_after_gmsh_failed():
    surface, volume = model_that_cannot_be_meshed()
    field = mesh_field([surface], [volume], 1.3, 0.1)
    field.register()
    with pytest.raises(meshgrow.Error):
        field.generate(3)
    gmsh.model.mesh.clear([e for e in gmsh.model.getEntities() if e != surface])
    gmsh.model.mesh.generate(1)
    assert element_count(*gmsh.model.getEntities(1)) >= 12 * 9


# ==== Line 4: volumes in volumes ====


def attach_by_fixed(volumes, size=0.4):
    field = meshgrow.SizeField()
    for volume in volumes:
        field.add_fixed([models.faces_of(volume[1])[0]], [volume], size, 1.3, 1.0)
    return field


@pytest.mark.parametrize("attached", [[0], [1]], ids=["inner", "outer"])
def test_both_of_two_nested_volumes_are_meshed_when_one_is_attached(attached):
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.8)
    volumes = models.nested_boxes(2, smallest=2.0)
    attach_by_fixed([volumes[i] for i in attached]).generate(3)
    assert all(element_count(v) > 100 for v in volumes)


@pytest.mark.parametrize("attached", [[0], [1], [2], [0, 2], [0, 1], [1, 2], [0, 1, 2]], ids=str)
def test_three_nested_volumes_are_all_meshed_whichever_are_attached(attached):
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1.2)
    volumes = models.nested_boxes(3, smallest=1.5)
    attach_by_fixed([volumes[i] for i in attached], 0.5).generate(3)
    sides = [1.5, 3.0, 6.0]
    for inner, outer, volume in zip([0.0] + sides, sides, volumes):
        assert np.isclose(total_volume(volume), outer**3 - inner**3, rtol=1e-6)


def total_volume(volume):
    return np.abs(signed_volumes(volume)).sum()


def test_sphere_in_box_is_meshed_when_only_the_outer_volume_is_attached():
    model = models.sphere_in_box(side=4.0)
    premesh([model.sphere], 0.3)
    mesh_field([model.sphere], [model.outer]).generate(3)
    assert element_count(model.inner) > 100
    assert element_count(model.outer) > 500


# ==== Line 6: seams ====


@pytest.mark.parametrize("shape", ["sphere", "cylinder", "torus"])
def test_source_with_a_seam_is_meshed_first_and_kept_as_it_was_meshed_then(shape):
    """Nothing is premeshed: the source is meshed by its own size, the volume by the field."""
    model = models.box_in_box_of(SHAPES[shape])
    with options(Mesh_MeshSizeMax=0.4):
        field = mesh_field(model.faces, [model.volume], 1.3, 1.0)
        field.generate(3)
    assert all(has_elements(f) for f in model.faces)
    assert element_count(model.volume) > 500
    points = np.array([[1.9, 1.9, 1.9], [1.5, 0.0, 1.5]])
    assert np.all(field.exact_size(*model.volume, points) > 0.4)


@pytest.mark.parametrize("shape", ["sphere", "cylinder", "torus"])
def test_seam_curves_belong_to_what_an_attachment_acts_on(shape):
    volume = models.single(SHAPES[shape])
    field = meshgrow.SizeField()
    field.add_fixed([volume], [volume], 0.2, 1.2, 1.0)
    curves = gmsh.model.getEntities(1)
    assert curves
    for curve in curves:
        assert field.size(*curve, [[0.1, 0.2, 0.3]])[0] == pytest.approx(0.2)


# ==== Line 10: unattached entities live by Gmsh's own sizes ====


def generate_with_sizes_on(entities, size):
    """Gmsh alone: `size` on these entities, its own proposals elsewhere."""
    def answer(dim, tag, x, y, z, proposed=1e22):
        return size if (dim, tag) in entities else proposed

    # Gmsh 4.8 passes five values, later versions the proposal as well.
    gmsh.model.mesh.setSizeCallback(lambda *arguments: answer(*arguments))
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.removeSizeCallback()


@pytest.mark.parametrize("extend", [0, 1])
def test_unattached_volume_has_the_density_that_gmsh_gives_it(extend):
    counts = []
    for with_field in (False, True):
        model = models.two_boxes()
        attached = closure([model.left])
        faces = models.faces_of(model.left[1])
        with options(Mesh_MeshSizeExtendFromBoundary=extend, Mesh_MeshSizeMax=0.25):
            if with_field:
                premesh(faces, 0.1)
                mesh_field(faces, [model.left], 1.1, 0.2).generate(3)
            else:
                generate_with_sizes_on(attached, 0.1)
        counts.append(element_count(model.right))
    assert counts[0] > 500
    assert counts[1] == pytest.approx(counts[0], rel=0.2)


def test_extension_from_the_boundary_is_the_users_where_nothing_is_attached():
    counts = []
    for extend in (0, 1):
        gmsh.option.setNumber("Mesh.MeshSizeMax", 5.0)
        model = models.sphere_in_box(side=4.0)
        premesh([model.sphere], 0.25)
        with options(Mesh_MeshSizeExtendFromBoundary=extend):
            mesh_field([model.sphere], [model.outer], 1.5, 1.0).generate(3)
        counts.append(element_count(model.inner))
    assert counts[1] > 1.5 * counts[0]


# ==== Twice ====


def test_generate_twice_changes_nothing():
    model = models.sphere_in_box(side=4.0)
    premesh([model.sphere], 0.35)
    field = mesh_field([model.sphere], [model.outer])
    field.generate(3)
    before = snapshots(gmsh.model.getEntities())
    field.generate(3)
    assert_kept(before)


def test_a_new_field_on_a_meshed_model_changes_nothing():
    model = models.two_boxes()
    premesh([model.between], 0.2)
    mesh_field([model.between], [model.left]).generate(3)
    before = snapshots(gmsh.model.getEntities())
    mesh_field([model.between], [model.right], 1.1, 0.3).generate(3)
    assert_kept(before)


def test_generate_by_dimensions_gives_what_generate_at_once_gives():
    counts = []
    for steps in ((3,), (1, 2, 3)):
        model = models.box_in_box_of(SHAPES["box"])
        premesh(model.faces, 0.4)
        field = mesh_field(model.faces, [model.volume], 1.3, 1.0)
        for dim in steps:
            field.generate(dim)
        counts.append([element_count(e) for e in model.walls + [model.volume]])
    assert counts[0] == counts[1]


def test_generate_of_a_lower_dimension_keeps_premeshed_surfaces_and_volumes():
    model = models.two_boxes()
    premesh([model.left], 0.25)
    before = snapshots(closure([model.left]))
    mesh_field([model.between], [model.right]).generate(1)
    assert_kept(before)
    assert not has_elements(model.right)
    assert all(has_elements(e) for e in gmsh.model.getEntities(1))
