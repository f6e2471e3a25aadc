"""What goes on around a run: listeners that stop it, other models, meshes that Gmsh will not keep."""

import os
import signal

import gmsh
import meshgrow
import numpy as np
import pytest
from meshgrow import _library

import models
from meshes import closure, element_count, has_elements, premesh, snapshots


def field_of(model, **options):
    field = meshgrow.SizeField(**options)
    field.add_mesh([model.sphere], [model.outer], 1.5, 1.0)
    return field


@pytest.mark.parametrize("kind", [ValueError, KeyboardInterrupt])
def test_an_exception_from_progress_stops_the_run_and_is_raised(kind):
    model = models.sphere_in_box()
    premesh([model.sphere], 0.35)
    before = snapshots(closure([model.sphere]))

    def stop(line):
        if "pass 2" in line:
            raise kind("enough")

    field = field_of(model, progress=stop)
    with pytest.raises(kind, match="enough"):
        field.generate(3)
    assert snapshots(before) == before
    assert not has_elements(model.outer)
    assert gmsh.option.getNumber("Mesh.MeshOnlyVisible") == 0


def test_a_field_does_not_mesh_while_it_is_meshing():
    model = models.sphere_in_box()
    field = field_of(model, progress=lambda line: field.generate(3))
    with pytest.raises(meshgrow.Error, match="meshing already"):
        field.generate(3)


def test_a_registered_field_leaves_other_models_alone():
    def box(name):
        gmsh.model.add(name)
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()

    def count():
        gmsh.model.mesh.generate(3)
        return element_count((3, 1))

    box("alone")
    alone = count()
    box("with field")
    field = meshgrow.SizeField()
    field.add_fixed([(2, 1)], [(3, 1)], 0.1, 1.2, 0.1)
    field.register()
    box("other")
    assert count() == alone
    gmsh.model.setCurrent("with field")
    assert count() > 2 * alone
    field.unregister()


@pytest.mark.parametrize("order", [1, 2])
def test_second_order_premesh_beside_a_mesh_of_either_order(order):
    model = models.sphere_in_box()
    premesh([model.sphere], 0.35)
    gmsh.model.mesh.setOrder(2)
    before = snapshots(closure([model.sphere]))
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    gmsh.logger.start()
    field_of(model).generate(3)
    warned = [line for line in gmsh.logger.get() if "higher order" in line]
    gmsh.logger.stop()
    assert len(warned) == (1 if order == 1 else 0)
    assert snapshots(before) == before


@pytest.mark.parametrize("entity, kind", [((2.7, 1), TypeError), ((2, "1"), TypeError),
                                          ((2, 2**31), ValueError)])
def test_entities_are_whole_numbers_of_gmsh(entity, kind):
    models.box()
    field = meshgrow.SizeField()
    with pytest.raises(kind):
        field.add_fixed([entity], [(3, 1)], 0.1, 1.2, 1.0)


def test_a_grid_asks_often_whether_to_stop():
    """Also where no line is told: lines about a grid come once a second."""
    model = models.sphere_in_box()
    premesh([model.sphere], 0.1)
    lines, asked = [], []
    field = field_of(model, evaluator="grid", progress=lines.append)

    @_library.STOP_REQUEST
    def stop(_):
        asked.append(len(lines))
        return int(len(asked) == 20)

    _library.check(_library.lib.meshgrow_field_set_stop(field._handle, stop, None))
    with pytest.raises(meshgrow.Error, match="Stopped as asked"):
        field.refresh()
    assert len(asked) == 20 and not any("done" in line for line in lines)
    field.refresh()
    assert any("done" in line for line in lines)


def test_ctrl_c_stops_a_grid_without_a_listener():
    """A signal that is due is served when the library asks whether to stop."""
    model = models.sphere_in_box()
    premesh([model.sphere], 0.1)
    field = field_of(model, evaluator="grid")
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    asked = field._raised.stop_request()
    calls = []

    @_library.STOP_REQUEST
    def interrupt_then_ask(data):
        calls.append(1)
        if len(calls) == 10:
            os.kill(os.getpid(), signal.SIGINT)
        return asked(data)

    _library.check(
        _library.lib.meshgrow_field_set_stop(field._handle, interrupt_then_ask, None))
    try:
        with pytest.raises(KeyboardInterrupt):
            field.generate(3)
    finally:
        signal.signal(signal.SIGINT, before)
    assert 10 <= len(calls) <= 11
    assert not has_elements(model.outer)
