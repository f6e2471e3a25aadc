"""What Gmsh makes of the sizes: as its size callback and in field.generate."""

import gc
import textwrap

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from child import run_child
from meshes import boundary, closure, corners, element_count, options, premesh, snapshots

def fixed_field(source, attach, size=0.05, growth_rate=1.2, size_limit=0.3):
    field = meshgrow.SizeField()
    field.add_fixed([source], [attach], size, growth_rate, size_limit)
    return field


def gmsh_alone(make, dim):
    """Number of elements of each entity by Gmsh alone."""
    make()
    gmsh.model.mesh.generate(dim)
    return {e: element_count(e) for e in gmsh.model.getEntities() if e[0] > 0}


# ==== Registering ====


def test_registered_field_gives_gmsh_its_sizes():
    model = models.square()
    field = fixed_field(model.bottom, model.face)
    field.register()
    gmsh.model.mesh.generate(2)
    lengths = np.linalg.norm(np.diff(corners(model.bottom, "Line"), axis=1), axis=2)
    assert lengths.max() < 1.1 * 0.05
    assert element_count(model.bottom) == pytest.approx(20, abs=2)
    assert element_count(model.top) < 10


def test_after_unregister_gmsh_sizes_are_its_own_again():
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.2)
    alone = gmsh_alone(models.square, 2)
    model = models.square()
    field = fixed_field(model.bottom, model.face)
    field.register()
    gmsh.model.mesh.generate(2)
    assert element_count(model.face) > 1.5 * alone[model.face]
    field.unregister()
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(2)
    assert {e: element_count(e) for e in alone} == alone


def test_register_twice_and_unregister_twice_are_allowed():
    model = models.square()
    field = fixed_field(model.bottom, model.face)
    field.register()
    field.register()
    gmsh.model.mesh.generate(1)
    assert element_count(model.bottom) == pytest.approx(20, abs=2)
    field.unregister()
    field.unregister()
    gmsh.model.mesh.generate(1)
    assert element_count(model.bottom) < 15


def test_a_field_is_registered_as_its_sources_are_meshed_then():
    model = models.square()
    premesh([model.bottom], 0.04)
    field = meshgrow.SizeField()
    field.add_mesh([model.bottom], [model.face], 1.2, 0.5)
    field.register()
    with options(Mesh_MeshOnlyEmpty=1):
        gmsh.model.mesh.generate(2)
    lengths = np.linalg.norm(np.diff(corners(model.left, "Line"), axis=1), axis=2).ravel()
    assert lengths.min() < 1.3 * 0.04
    assert lengths.max() < 1.3 * (0.04 + (1 - 1 / 1.2) * 1.0)


def test_generate_leaves_no_callback_behind():
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.2)
    alone = gmsh_alone(models.square, 2)
    model = models.square()
    field = fixed_field(model.bottom, model.face)
    field.generate(2)
    assert element_count(model.face) > 1.5 * alone[model.face]
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(2)
    assert {e: element_count(e) for e in alone} == alone


def test_registered_field_is_still_registered_after_its_own_generate():
    model = models.square()
    field = fixed_field(model.bottom, model.face)
    field.register()
    field.generate(2)
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(1)
    assert element_count(model.bottom) == pytest.approx(20, abs=2)


def test_a_field_deleted_while_registered_is_gone_from_gmsh():
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.2)
    alone = gmsh_alone(models.square, 2)
    model = models.square()
    field = fixed_field(model.bottom, model.face)
    field.register()
    del field
    gc.collect()
    gmsh.model.mesh.generate(2)
    assert {e: element_count(e) for e in alone} == alone


def test_deleting_an_unregistered_field_leaves_the_registered_one():
    model = models.square()
    other = fixed_field(model.bottom, model.face, size=0.2)
    other.register()
    field = fixed_field(model.bottom, model.face)
    field.register()
    other.unregister()
    del other
    gc.collect()
    gmsh.model.mesh.generate(1)
    assert element_count(model.bottom) == pytest.approx(20, abs=2)


# ==== The smaller size wins ====


def test_smaller_background_field_of_the_user_wins():
    model = models.square()
    ball = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(ball, "F", "0.02 + 0.2 * y")
    gmsh.model.mesh.field.setAsBackgroundMesh(ball)
    fixed_field(model.top, model.face, 0.05, 1.2, 0.3).generate(2)
    assert element_count(model.bottom) == pytest.approx(1 / 0.02, rel=0.1)
    assert element_count(model.top) == pytest.approx(1 / 0.05, rel=0.15)


def test_smaller_sizes_at_points_of_the_user_win():
    model = models.square()
    gmsh.model.mesh.setSize(boundary([model.bottom]), 0.02)
    field = fixed_field(model.top, model.face, 0.1, 1.2, 0.3)
    with options(Mesh_MeshSizeExtendFromBoundary=0):
        field.generate(2)
    assert element_count(model.bottom) == pytest.approx(1 / 0.02, rel=0.1)
    assert element_count(model.top) == pytest.approx(10, abs=2)


def test_larger_sizes_of_the_user_do_not_make_the_field_coarser():
    model = models.square()
    gmsh.model.mesh.setSize(gmsh.model.getEntities(0), 0.5)
    background = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(background, "F", "0.5")
    gmsh.model.mesh.field.setAsBackgroundMesh(background)
    fixed_field(model.bottom, model.face, 0.05).generate(2)
    assert element_count(model.bottom) == pytest.approx(20, abs=2)


def test_answer_is_the_smaller_of_proposal_and_field():
    from meshgrow._library import lib
    model = models.square()
    field = fixed_field(model.bottom, model.face)
    field.refresh()

    def answer(entity, proposed):
        return lib.meshgrow_field_answer(field._handle, *entity, 0.5, 0.0, 0.0, proposed)

    assert answer(model.face, 0.01) == 0.01
    assert answer(model.face, 1e22) == pytest.approx(0.05, rel=0.06)
    assert answer((1, 99), 0.7) == 0.7
    assert answer((7, 1), 0.7) == 0.7
    assert answer((-1, -1), 0.7) == 0.7
    assert lib.meshgrow_field_answer(None, *model.face, 0.5, 0.0, 0.0, 0.7) == 0.7
    assert lib.meshgrow_field_answer(field._handle, *model.face, np.nan, 0.0, 0.0, 0.7) == 0.7


def test_unattached_entities_keep_the_elements_that_gmsh_gives_them():
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.2)
    alone = gmsh_alone(models.two_boxes, 3)
    model = models.two_boxes()
    attached = closure([model.right])
    # From the corners at x = 2, so that no size of the field is small at x = 1.
    field = fixed_field(corner_face(model.right, 2.0), model.right, 0.05, 2.0, 0.5)
    field.register()
    gmsh.model.mesh.generate(3)
    for entity, count in alone.items():
        if entity not in attached and entity[0] < 3:
            assert element_count(entity) == pytest.approx(count, abs=0 if entity[0] == 1 else 4)
    assert element_count(model.right) > 2 * alone[model.right]
    assert element_count(model.left) == pytest.approx(alone[model.left], rel=0.1)


def corner_face(volume, x):
    return next(f for f in models.faces_of(volume[1])
                if gmsh.model.occ.getCenterOfMass(*f)[0] == pytest.approx(x))


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_sizes_are_asked_for_from_several_threads(threads):
    gmsh.option.setNumber("General.NumThreads", threads)
    model = models.sphere_in_box(side=4.0)
    premesh([model.sphere], 0.3)
    before = snapshots([model.sphere])
    field = meshgrow.SizeField()
    field.add_mesh([model.sphere], [model.outer], 1.3, 0.6)
    field.generate(3)
    assert snapshots([model.sphere]) == before
    report = meshgrow.report(3, [model.outer], field)
    assert report["ratio_99"] < 1.6
    assert report["length_share_over_2"] < 0.02


def test_hxt_asks_for_the_sizes_from_several_threads():
    gmsh.option.setNumber("General.NumThreads", 4)
    gmsh.option.setNumber("Mesh.Algorithm3D", 10)
    model = models.box_in_box_of(lambda occ: occ.addSphere(0, 0, 0, 1))
    premesh(model.faces, 0.25)
    before = snapshots(model.faces)
    field = meshgrow.SizeField(calibrate=True)  # without, HXT itself scatters, with threads
    field.add_mesh(model.faces, [model.volume], 1.3, 0.6)
    field.generate(3)
    assert snapshots(model.faces) == before
    assert meshgrow.report(3, [model.volume], field)["length_share_over_2"] < 0.03


# ==== Several models and fields ====


def square_called(name):
    gmsh.model.add(name)
    occ = gmsh.model.occ
    face = occ.addRectangle(0, 0, 0, 1, 1)
    occ.synchronize()
    bottom = next(c for c in boundary([(2, face)])
                  if abs(occ.getCenterOfMass(*c)[1]) < 1e-6)
    return (2, face), bottom


def test_fields_of_two_models_mesh_their_own_and_restore_the_current_model():
    made = {}
    for name, size in (("coarse", 0.1), ("fine", 0.05)):
        face, bottom = square_called(name)
        made[name] = (fixed_field(bottom, face, size), bottom, size)
    gmsh.model.add("bystander")
    for name, (field, _, _) in made.items():
        field.generate(2)
        assert gmsh.model.getCurrent() == "bystander"
        field.size(2, 1, [[0.5, 0.5, 0]])
        assert gmsh.model.getCurrent() == "bystander"
    for name, (_, bottom, size) in made.items():
        gmsh.model.setCurrent(name)
        assert element_count(bottom) == pytest.approx(1 / size, rel=0.15)


def test_registering_and_unregistering_restores_the_current_model():
    face, bottom = square_called("meshed")
    field = fixed_field(bottom, face)
    gmsh.model.add("bystander")
    field.register()
    assert gmsh.model.getCurrent() == "bystander"
    gmsh.model.setCurrent("meshed")
    gmsh.model.mesh.generate(1)
    assert element_count(bottom) == pytest.approx(20, abs=2)
    gmsh.model.setCurrent("bystander")
    field.unregister()
    assert gmsh.model.getCurrent() == "bystander"


def test_current_model_is_restored_when_generate_fails():
    face, bottom = square_called("meshed")
    field = fixed_field(bottom, face)
    gmsh.model.add("bystander")
    with pytest.raises(meshgrow.Error):
        field.generate(7)
    assert gmsh.model.getCurrent() == "bystander"


# ==== Models and sessions that are gone: an error, no crash ====


HEAD = """
import gc, gmsh, meshgrow
import models
from child import told
from meshes import element_count


def start():
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)


def field_of(model):
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
    return field


def elements_of_a_new_model():
    model = models.square()
    gmsh.model.mesh.generate(2)
    return element_count(model.face)


start()
"""


def run(code):
    """Lines that code prints after HEAD, in a process of its own since a failure may be a crash."""
    return run_child(HEAD + textwrap.dedent(code))


@pytest.mark.parametrize("call", ["field.generate, 2", "field.register", "field.refresh",
                                  "field.size, 2, 1, [[0, 0, 0]]", "field.summary"])
def test_a_field_whose_model_was_removed_says_so(call):
    lines = run("""
        model = models.square()
        field = field_of(model)
        gmsh.model.remove()
        gmsh.model.add('other')
        told(%s)
        """ % call)
    assert len(lines) == 1 and lines[0].startswith("Error: ") and "square" in lines[0]


@pytest.mark.parametrize("call", ["field.generate, 2", "field.register", "field.refresh",
                                  "field.size, 2, 1, [[0, 0, 0]]"])
def test_a_field_after_finalize_says_that_gmsh_is_not_initialized(call):
    lines = run("""
        field = field_of(models.square())
        gmsh.finalize()
        told(%s)
        """ % call)
    assert len(lines) == 1 and lines[0].startswith("Error: ")
    assert "initialize" in lines[0]


def test_a_registered_field_deleted_after_its_model_leaves_other_models_meshable():
    lines = run("""
        alone = elements_of_a_new_model()
        gmsh.model.remove()
        field = field_of(models.square())
        field.register()
        gmsh.model.remove()
        del field
        gc.collect()
        others = [bytes(100) * 50 for _ in range(1000)]  # what was freed is written over
        print(elements_of_a_new_model() == alone)
        """)
    assert lines == ["True"]


def test_a_registered_field_deleted_after_finalize_does_not_haunt_the_next_session():
    lines = run("""
        alone = elements_of_a_new_model()
        field = field_of(models.square())
        field.register()
        gmsh.finalize()
        del field
        gc.collect()
        start()
        print(elements_of_a_new_model() == alone)
        """)
    assert lines == ["True"]


def test_a_registered_field_deleted_in_the_next_session_does_not_haunt_it():
    lines = run("""
        alone = elements_of_a_new_model()
        field = field_of(models.square())
        field.register()
        gmsh.finalize()
        start()
        del field
        gc.collect()
        print(elements_of_a_new_model() == alone)
        """)
    assert lines == ["True"]


def test_a_process_may_end_with_a_registered_field():
    assert run("""
        field = field_of(models.square())
        field.register()
        gmsh.model.mesh.generate(2)
        print('end')
        """) == ["end"]


def test_a_process_may_end_with_a_registered_field_after_finalize():
    assert run("""
        field = field_of(models.square())
        field.register()
        gmsh.model.mesh.generate(2)
        gmsh.finalize()
        print('end')
        """) == ["end"]
