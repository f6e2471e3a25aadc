"""The plain way: register(), and sources that get their mesh within the user's own generate()."""

import gmsh
import meshgrow
import pytest

import models
from meshes import element_count, has_elements, options, premesh


def sphere_in_box_with_late_source(**options_of_field):
    model = models.sphere_in_box(4.0)
    field = meshgrow.SizeField(**options_of_field)
    field.add_fixed([model.sphere], [model.sphere], 0.15, 1.0, 0.15)
    field.add_mesh([model.sphere], [model.outer], 1.2, 0.6)
    return model, field


def effective(field):
    return [function["effective"] for function in field.statistics()["functions"]]


@pytest.mark.parametrize("threads", [1, 4])
@pytest.mark.parametrize("algorithm", [1, 10], ids=["Delaunay", "HXT"])
def test_a_source_meshed_in_the_same_run_is_read_before_the_next_dimension(algorithm, threads):
    model, field = sphere_in_box_with_late_source()
    field.register()
    assert effective(field) == [True, False]
    with options(Mesh_Algorithm3D=algorithm, General_NumThreads=threads,
                 Mesh_MeshSizeExtendFromBoundary=0, Mesh_MeshSizeMax=0.6):
        gmsh.model.mesh.generate(3)
    assert effective(field) == [True, True]
    late = element_count(model.outer)
    gmsh.model.mesh.clear()
    field.unregister()
    none = meshgrow.SizeField()
    none.add_fixed([model.sphere], [model.sphere], 0.15, 1.0, 0.15)
    none.register()
    with options(Mesh_Algorithm3D=algorithm, Mesh_MeshSizeExtendFromBoundary=0,
                 Mesh_MeshSizeMax=0.6):
        gmsh.model.mesh.generate(3)
    # Without the growth the outside is as coarse as Gmsh likes right beside the sphere.
    assert late > 1.3 * element_count(model.outer)


def test_sizes_of_a_late_source_are_exact_until_refresh_builds_grids():
    model, field = sphere_in_box_with_late_source(evaluator="grid")
    field.register()
    with options(Mesh_MeshSizeMax=0.6):
        gmsh.model.mesh.generate(2)
    near = [[1.05, 0.1, 0.2]]
    # The volume asks first: that is what reads the source.
    with options(Mesh_MeshSizeMax=0.6):
        gmsh.model.mesh.generate(3)
    assert field.exact_size(*model.outer, near)[0] < 0.3
    field.refresh()
    group = next(g for g in field.statistics()["groups"] if list(model.outer) in g["entities"])
    assert group["grid"] is not None
    assert field.size(*model.outer, near) == pytest.approx(field.exact_size(*model.outer, near), 0.06)


def test_refresh_between_calls_reads_the_sources_again():
    model = models.square(2.0)
    field = meshgrow.SizeField()
    field.add_mesh([model.left], [model.face], 1.2, 1.0)
    premesh([model.left], 0.5)
    field.register()
    coarse = field.size(*model.face, [[0.01, 1, 0]])[0]
    field.unregister()
    premesh([model.left], 0.05)
    field.refresh()
    assert field.size(*model.face, [[0.01, 1, 0]])[0] < 0.3 * coarse


def test_a_second_run_reads_a_late_source_as_it_is_meshed_then():
    model = models.square(2.0)
    size = {"source": 0.05}
    field = meshgrow.SizeField()
    field.add_mesh([model.left], [model.face], 1.2, 1.0)
    field.combine(lambda dim, tag, x, y, z, lc: size["source"] if (dim, tag) == model.left else lc)
    field.register()
    gmsh.model.mesh.generate(2)
    fine = element_count(model.face)
    gmsh.model.mesh.clear()
    size["source"] = 0.5
    gmsh.model.mesh.generate(2)
    assert element_count(model.left) <= 8
    assert element_count(model.face) < 0.5 * fine


def test_a_curve_source_meshed_in_the_same_run_acts_on_the_surface():
    model = models.square(2.0)
    field = meshgrow.SizeField()
    field.add_fixed([model.left], [model.left], 0.05, 1.0, 0.05)
    field.add_mesh([model.left], [model.face], 1.2, 1.0)
    field.register()
    with options(Mesh_MeshSizeExtendFromBoundary=0):
        gmsh.model.mesh.generate(2)
    near = meshgrow.report(2, [model.face], field)
    assert near["smallest_size"] < 0.08 and near["length_share_over_2"] < 0.02


# ==== Several fields ====


def has_one_callback():
    return gmsh.option.getString("General.Version").startswith("4.8")


def test_a_second_registered_model_is_refused_where_gmsh_has_one_callback():
    first = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([first.left], [first.face], 0.1, 1.2, 0.3)
    field.register()
    gmsh.model.add("second")
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    second = meshgrow.SizeField()
    second.add_fixed([(2, 1)], [(2, 1)], 0.1, 1.2, 0.3)
    if has_one_callback():
        with pytest.raises(meshgrow.Error, match='one size callback.*"square".*unregister'):
            second.register()
        field.unregister()
    second.register()
    gmsh.model.mesh.generate(2)
    assert element_count((2, 1)) > 150


def test_generate_of_another_field_leaves_a_registered_one_in_force():
    model = models.square()
    registered = meshgrow.SizeField()
    registered.add_fixed([model.face], [model.face], 0.05, 1.2, 0.05)
    registered.register()
    other = meshgrow.SizeField()
    other.add_fixed([model.face], [model.face], 0.3, 1.2, 0.3)
    other.generate(2)
    coarse = element_count(model.face)
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(2)
    assert element_count(model.face) > 5 * coarse
    registered.unregister()
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(2)
    assert has_elements(model.face) and element_count(model.face) < 5 * coarse
