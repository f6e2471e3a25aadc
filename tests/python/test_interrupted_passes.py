"""Ctrl-C and exceptions of the user's own code, in every pass and in all that a field does else.

The signal is raised by what is called at that time, so that it comes where it shall."""

import os
import signal

import gmsh
import meshgrow
import pytest
from meshgrow import _library

import models
from meshes import closure, element_count, has_elements, premesh, snapshots

OPTIONS = ("Mesh.MeshOnlyVisible", "Mesh.MeshOnlyEmpty", "Mesh.Renumber", "Mesh.ElementOrder",
           "Mesh.MeshSizeExtendFromBoundary", "Mesh.MeshSizeMin", "Mesh.MeshSizeMax",
           "Mesh.MeshSizeFactor", "General.AbortOnError", "General.Verbosity")


@pytest.fixture(autouse=True)
def pythons_own_interrupts():
    """The module gmsh would let Ctrl-C end the process."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupt():
    os.kill(os.getpid(), signal.SIGINT)


def fail():
    raise ZeroDivisionError("of the user")


BREAKS = {KeyboardInterrupt: interrupt, ZeroDivisionError: fail}


class Breaking:
    """Sizes of the user, of which the n-th question of a dimension breaks."""

    def __init__(self, dim, number, action):
        self.dim, self.number, self.action = dim, number, action
        self.count = 0

    def __call__(self, dim, tag, x, y, z, lc=1e22):
        self.count += dim == self.dim
        if self.count == self.number:
            self.number = -1
            self.action()
        return 1e22


def state():
    entities = gmsh.model.getEntities()
    return ([gmsh.option.getNumber(name) for name in OPTIONS], entities,
            [gmsh.model.getVisibility(*e) for e in entities])


def stop_at(field, number, action=interrupt):
    """The field's number-th question whether to stop breaks instead; returns what must be kept."""
    ask = field._raised.stop_request()
    calls = []

    @_library.STOP_REQUEST
    def break_then_ask(data):
        calls.append(1)
        if len(calls) == number:
            action()
        return ask(data)

    _library.check(_library.lib.meshgrow_field_set_stop(field._handle, break_then_ask, None))
    return break_then_ask


# ==== In a pass ====


def mapped_square():
    model = models.square()
    premesh([model.bottom], 0.1)
    gmsh.model.mesh.setTransfiniteSurface(model.face[1])
    return model


@pytest.mark.parametrize("kind", BREAKS)
@pytest.mark.parametrize("dim", [1, 2, 3])
def test_a_break_in_a_pass_is_raised_and_leaves_all_as_before(dim, kind):
    model = models.sphere_in_box(side=3.0)
    premesh([model.sphere], 0.4)
    gmsh.model.setVisibility(gmsh.model.getEntities()[::3], 0)
    kept = snapshots(closure([model.sphere]))
    before = state()
    field = meshgrow.SizeField()
    field.add_mesh([model.sphere], [model.outer], 1.5, 0.6)
    field.combine(Breaking(dim, 5, BREAKS[kind]))
    with pytest.raises(kind):
        field.generate(3)
    assert snapshots(kept) == kept and state() == before
    field.generate(3)  # the same callback breaks only once
    assert snapshots(kept) == kept and state() == before
    assert element_count(model.outer) > 500


@pytest.mark.parametrize("kind", BREAKS)
def test_a_break_while_curves_are_adjusted_leaves_none_half_adjusted(kind):
    def run(number):
        model = mapped_square()
        kept = snapshots(closure([model.bottom]))
        before = state()
        sizes = Breaking(1, number, BREAKS[kind])
        asked = {}
        field = meshgrow.SizeField(
            progress=lambda line: asked.setdefault(line.split()[0], sizes.count))
        field.add_fixed([model.top], [model.face], 0.05, 1.2, 0.5)
        field.combine(sizes)
        try:
            field.generate(2)
        finally:
            assert snapshots(kept) == kept and state() == before
        return asked, model, kept

    asked, _, _ = run(-1)
    last_question = asked["Adjusted"]
    gmsh.model.remove()
    with pytest.raises(kind):
        run(last_question)
    (face,) = gmsh.model.getEntities(2)
    assert not has_elements(face)
    field = meshgrow.SizeField()
    field.add_fixed([face], [face], 0.05, 1.2, 0.5)
    field.generate(2)
    assert has_elements(face)


# ==== Elsewhere ====


WORKS = {
    "generate": lambda field, model, path: field.generate(3),
    "refresh": lambda field, model, path: field.refresh(),
    "register": lambda field, model, path: field.register(),
    "save": lambda field, model, path: field.save(path),
    "size": lambda field, model, path: field.size(*model.outer, [[1.2, 0, 0]]),
    "smallest_size": lambda field, model, path: field.smallest_size([[1.2, 0, 0]]),
    "add_view": lambda field, model, path: field.add_view(),
    "write_view": lambda field, model, path: field.write_view(path),
    "probe": lambda field, model, path: field.probe(*model.outer, [1.2, 0, 0]),
    "report": lambda field, model, path: meshgrow.report(2, field=field),
}


@pytest.mark.parametrize("work", WORKS)
def test_an_interrupt_while_a_grid_is_built_is_raised_and_the_field_is_usable_again(work, tmp_path):
    model = models.sphere_in_box(side=3.0)
    premesh([model.sphere], 0.3)
    kept = snapshots(closure([model.sphere]))
    before = state()
    path = tmp_path / "sizes.vtu"
    path.write_text("of before")
    field = meshgrow.SizeField(evaluator="grid")
    field.add_mesh([model.sphere], [model.outer], 1.2, 0.8)
    request = stop_at(field, 1)
    with pytest.raises(KeyboardInterrupt):
        WORKS[work](field, model, path)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    assert os.listdir(tmp_path) == ["sizes.vtu"] and path.read_text() == "of before"
    assert snapshots(kept) == kept and state() == before
    WORKS[work](field, model, path)
    assert field.size(*model.outer, [[1.0, 0, 0]])[0] == pytest.approx(0.3, rel=0.3)
    del request


@pytest.mark.parametrize("kind", BREAKS)
def test_a_break_in_progress_of_refresh_is_raised(kind):
    model = models.sphere_in_box(side=3.0)
    premesh([model.sphere], 0.3)
    breaks = [BREAKS[kind]]

    def progress(line):
        if breaks:
            breaks.pop()()

    field = meshgrow.SizeField(evaluator="grid", progress=progress)
    field.add_mesh([model.sphere], [model.outer], 1.5, 0.8)
    with pytest.raises(kind):
        field.refresh()
    field.refresh()
    assert field.size(*model.outer, [[1.0, 0, 0]])[0] == pytest.approx(0.3, rel=0.3)


@pytest.mark.parametrize("kind", BREAKS)
def test_a_break_in_gmshs_own_run_is_raised_by_the_field_when_it_is_next_asked(kind):
    """Nothing can be raised through Gmsh; its run goes on with the field's sizes alone."""
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
    field.combine(Breaking(1, 5, BREAKS[kind]))
    field.register()
    if kind is KeyboardInterrupt:
        signal.signal(signal.SIGINT, lambda *_: fail())  # Python raises it in the callback
        kind = ZeroDivisionError
    gmsh.model.mesh.generate(2)
    assert element_count(model.bottom) == pytest.approx(20, abs=2)
    with pytest.raises(kind):
        field.refresh()
    field.refresh()
    field.unregister()
