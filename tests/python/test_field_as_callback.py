"""A field is a size callback itself: handed to Gmsh, or called in a callback of the user's own."""

import gc
import weakref

import gmsh
import meshgrow
import pytest

import models
from child import run_child
from meshes import element_count, options, premesh

NO_SIZE = 1e22


def is_4_8():
    return gmsh.option.getString("General.Version").startswith("4.8")


def set_callback(sizes):
    """Hands `sizes(dim, tag, x, y, z, lc)` to Gmsh, whose 4.8 passes no lc."""
    if is_4_8():
        gmsh.model.mesh.setSizeCallback(
            lambda dim, tag, x, y, z: sizes(dim, tag, x, y, z, NO_SIZE))
    else:
        gmsh.model.mesh.setSizeCallback(sizes)


def counts():
    return {entity: element_count(entity) for entity in gmsh.model.getEntities()
            if entity[0] > 0}


def premeshed_sphere_in_box():
    """A sphere meshed before, a field that grows from it, and Gmsh's options for the runs."""
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.6)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    model = models.sphere_in_box(4.0)
    premesh([model.sphere], 0.2)
    field = meshgrow.SizeField()
    field.add_mesh([model.sphere], [model.outer], 1.2, 0.6)
    return model, field


def counts_when_registered(make):
    _, field = make()
    field.register()
    gmsh.model.mesh.generate(3)
    result = counts()
    field.unregister()
    gmsh.model.remove()
    return result


# ==== Handed to Gmsh ====


@pytest.mark.parametrize("refreshed", [False, True], ids=["at once", "after refresh"])
def test_a_field_handed_to_gmsh_meshes_as_a_registered_one(refreshed):
    registered = counts_when_registered(premeshed_sphere_in_box)
    model, field = premeshed_sphere_in_box()
    if refreshed:
        field.refresh()
    gmsh.model.mesh.setSizeCallback(field)
    gmsh.model.mesh.generate(3)
    assert counts() == registered
    assert element_count(model.outer) > 5000


@pytest.mark.parametrize("threads", [2, 4])
def test_several_threads_may_call_a_field(threads):
    gmsh.option.setNumber("General.NumThreads", threads)
    registered = counts_when_registered(premeshed_sphere_in_box)
    model, field = premeshed_sphere_in_box()
    gmsh.model.mesh.setSizeCallback(field)
    gmsh.model.mesh.generate(3)
    assert element_count(model.outer) == pytest.approx(registered[model.outer], rel=0.05)


@pytest.mark.parametrize("kind", ["fixed", "curvature", "proximity", "defaults"])
def test_all_kinds_are_read_within_the_run(kind):
    def make():
        model = models.sphere_in_box(4.0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.6)
        field = meshgrow.SizeField()
        attach = [model.inner, model.outer]
        if kind == "fixed":
            field.add_fixed([model.sphere], attach, 0.15, 1.2, 0.6)
        elif kind == "curvature":
            field.add_curvature([model.sphere], attach, 15, 1.2, 0.6)
        elif kind == "proximity":
            field.add_proximity(attach, attach, 6, 1.2, 0.6)
        else:
            field.create_defaults(size_limit=0.6)
        return model, field

    registered = counts_when_registered(make)
    _, field = make()
    gmsh.model.mesh.setSizeCallback(field)
    gmsh.model.mesh.generate(3)
    assert counts() == registered


def test_a_source_that_the_run_meshes_is_read_in_time():
    def make():
        model = models.sphere_in_box(4.0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.6)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
        field = meshgrow.SizeField()
        field.add_fixed([model.sphere], [model.sphere], 0.15, 1.0, 0.15)
        field.add_mesh([model.sphere], [model.outer], 1.2, 0.6)
        return model, field

    registered = counts_when_registered(make)
    _, field = make()
    gmsh.model.mesh.setSizeCallback(field)
    gmsh.model.mesh.generate(3)
    assert counts() == registered
    assert [f["effective"] for f in field.statistics()["functions"]] == [True, True]
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(3)
    for entity, count in counts().items():
        assert count == pytest.approx(registered[entity], rel=0.05, abs=2)


@pytest.mark.parametrize("then", ["added", "modified"])
def test_a_function_changed_after_a_run_acts_in_the_next(then):
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.1, 1.0, 0.1, name="bottom")
    gmsh.model.mesh.setSizeCallback(field)
    gmsh.model.mesh.generate(2)
    assert element_count(model.bottom) == 10
    gmsh.model.mesh.clear()
    text = "fixed source Curve{%d} attach Surface{%d} size 0.05 growth 1 limit 0.05" % (
        model.bottom[1], model.face[1])
    field.add(text) if then == "added" else field.modify("bottom", text)
    gmsh.model.mesh.generate(2)
    assert element_count(model.bottom) == 20


def test_a_mesh_that_gmsh_throws_away_is_as_when_its_function_was_added():
    model = models.sphere_in_box(4.0)
    premesh([model.sphere], 0.1)
    field = meshgrow.SizeField()
    field.add_mesh([model.sphere], [model.outer], 1.0, 0.6)  # its own size everywhere
    asked = {}

    def sizes(dim, tag, x, y, z, lc):
        answer = field(dim, tag, x, y, z, lc)
        asked.setdefault(dim, []).append(answer)
        return min(answer, 0.5)

    set_callback(sizes)
    gmsh.model.mesh.generate(1)
    assert not gmsh.model.mesh.getElements(*model.sphere)[1]
    assert max(asked[1]) < 0.15
    gmsh.model.mesh.removeSizeCallback()


# ==== Called in a callback of the user's own ====


def test_the_smaller_of_own_and_the_fields_sizes_in_a_callback():
    model, field = premeshed_sphere_in_box()
    set_callback(lambda dim, tag, x, y, z, lc: min(0.3, field(dim, tag, x, y, z, lc)))
    gmsh.model.mesh.generate(3)
    called = counts()
    gmsh.model.remove()
    model, field = premeshed_sphere_in_box()
    field.combine(lambda dim, tag, x, y, z, lc: 0.3)  # the same in one line changed
    field.register()
    gmsh.model.mesh.generate(3)
    assert counts() == called


def test_the_answer_is_the_smaller_of_proposal_and_field():
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
    at = (0.5, 0.0, 0.0)
    assert field(*model.face, *at, 0.01) == 0.01
    assert field(*model.face, *at, lc=1.0) == pytest.approx(0.05, rel=0.06)
    assert field(*model.face, *at) == field(*model.face, *at, 1.0)
    assert field(*model.face, *at) == field.size(*model.face, [at])[0]
    # Where nothing acts, and for what is no entity, the proposal; none is Gmsh's "no size".
    assert field(1, 99, *at) == NO_SIZE
    assert field(1, 99, *at, 0.7) == 0.7
    assert field(-1, -1, *at, 0.7) == 0.7
    assert field(7, 1, *at, 0.7) == 0.7
    assert field(*model.face, float("nan"), 0.0, 0.0, 0.7) == 0.7
    assert isinstance(field(*model.face, *at), float)


def test_a_field_of_another_model_than_the_current_one_proposes_nothing_and_says_so_once():
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
    gmsh.model.add("other")
    gmsh.logger.start()
    for _ in range(3):
        assert field(*model.face, 0.5, 0.0, 0.0, 0.7) == 0.7
    told = [line for line in gmsh.logger.get() if line.startswith("Warning")]
    gmsh.logger.stop()
    assert len(told) == 1 and '"square"' in told[0] and '"other"' in told[0], told
    gmsh.model.setCurrent("square")
    assert field(*model.face, 0.5, 0.0, 0.0, 0.7) < 0.06


def test_a_field_combined_with_itself_does_no_harm():
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
    field.generate(2)
    alone = counts()
    for sizes in (field, lambda dim, tag, x, y, z, lc: min(5.0, field(dim, tag, x, y, z, lc))):
        gmsh.model.mesh.clear()
        field.combine(sizes)
        field.generate(2)
        assert counts() == alone
        gmsh.model.mesh.clear()
        field.register()
        gmsh.model.mesh.generate(2)
        assert element_count(model.bottom) == alone[model.bottom]
        field.unregister()


# ==== What goes wrong ====


def test_a_field_that_cannot_answer_says_so_once_and_raises_nothing():
    model = models.square()
    field = meshgrow.SizeField(strict=True)
    field.add_mesh([model.bottom], [model.face], 1.2, 0.3)
    gmsh.logger.start()
    for _ in range(3):
        assert field(*model.face, 0.5, 0.0, 0.0, 0.7) == 0.7
    told = [line for line in gmsh.logger.get() if "cannot answer" in line]
    gmsh.logger.stop()
    assert len(told) == 1 and "has no mesh" in told[0] and told[0].startswith("Warning")
    premesh([model.bottom], 0.1)
    field.refresh()
    assert field(*model.face, 0.5, 0.0, 0.0, 0.7) < 0.11


def test_a_source_without_a_mesh_is_told_of_when_a_run_does_not_mesh_it():
    model = models.square()
    field = meshgrow.SizeField()
    field.add_mesh([model.face], [model.bottom], 1.2, 0.3)
    gmsh.logger.start()
    gmsh.model.mesh.setSizeCallback(field)
    gmsh.model.mesh.generate(1)
    told = gmsh.logger.get()
    gmsh.logger.stop()
    assert any("Surface 1 has no mesh" in line for line in told)


def test_a_field_lives_as_long_as_gmsh_may_call_it():
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
    alive = weakref.ref(field)
    gmsh.model.mesh.setSizeCallback(field)
    del field
    gc.collect()
    assert alive() is not None
    gmsh.model.mesh.generate(1)
    assert element_count(model.bottom) == pytest.approx(20, abs=2)


def test_calls_after_finalize_answer_the_proposal():
    assert run_child("""
import gmsh, meshgrow, models
gmsh.initialize(readConfigFiles=False)
gmsh.option.setNumber("General.Terminal", 0)
model = models.square()
field = meshgrow.SizeField()
field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
gmsh.model.mesh.setSizeCallback(field)
gmsh.model.mesh.generate(1)
gmsh.finalize()
print(field(*model.face, 0.5, 0.0, 0.0, 0.7))
""")[-1] == "0.7"


# ==== A saved field ====


def test_a_saved_field_is_a_callback_too(tmp_path):
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
    field.save(tmp_path / "sizes.mgf")
    loaded = meshgrow.SizeField.load(tmp_path / "sizes.mgf")
    gmsh.model.mesh.setSizeCallback(loaded)
    gmsh.model.mesh.generate(2)
    assert element_count(model.bottom) == pytest.approx(20, abs=2)


def test_a_saved_field_answers_without_gmsh(tmp_path):
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
    path = str(tmp_path / "sizes.mgf")
    field.save(path)
    asked = (*model.face, 0.5, 0.1, 0.0)
    assert run_child("import meshgrow\nprint(meshgrow.SizeField.load(%r)(*%r))" % (path, asked)) \
        == [repr(field(*asked))]
