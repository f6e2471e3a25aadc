"""A user's own size callback beside the field."""

import gmsh
import meshgrow
import pytest

import models
from meshes import element_count, has_elements, options, premesh


def square_with_a_fine_side():
    model = models.square(2.0)
    premesh([model.left], 0.1)
    field = meshgrow.SizeField()
    field.add_mesh([model.left], [model.face], 1.2, 0.5)
    return model, field


def six(size):
    return lambda dim, tag, x, y, z, lc: size


def five(size):
    return lambda dim, tag, x, y, z: size


class Counter:
    """A callable object with a method's signature."""

    def __init__(self):
        self.dims = set()

    def __call__(self, dim, tag, x, y, z, lc):
        self.dims.add(dim)
        return lc


@pytest.mark.parametrize("callback", [six(0.04), five(0.04)], ids=["six", "five"])
def test_the_smaller_of_the_users_and_the_fields_size_wins(callback):
    model, field = square_with_a_fine_side()
    field.combine(callback)
    with options(Mesh_MeshSizeMax=1.0):
        field.generate(2)
    # Two units of 0.04, an equilateral triangle 0.43 of the square of its side.
    assert 4 / (0.433 * 0.04**2) * 0.7 < element_count(model.face) < 4 / (0.433 * 0.04**2) * 1.5


def test_larger_sizes_of_the_user_change_nothing():
    model, field = square_with_a_fine_side()
    field.generate(2)
    alone = element_count(model.face)
    for callback in (six(10.0), six(0.0), six(-1.0), six(float("nan")), six(float("inf")), None):
        gmsh.model.mesh.clear([model.face, model.bottom, model.right, model.top])
        field.combine(callback)
        field.generate(2)
        assert element_count(model.face) == alone


def test_the_users_sizes_act_where_no_function_does():
    model = models.two_boxes()
    premesh([model.between], 0.3)
    field = meshgrow.SizeField()
    field.add_mesh([model.between], [model.right], 1.2, 0.5)
    field.combine(six(0.1))
    with options(Mesh_MeshSizeMax=0.6):
        field.generate(3)
    assert element_count(model.left) > 3000


def test_the_users_sizes_are_asked_in_every_dimension_and_told_the_size_so_far():
    model = models.box()
    count = Counter()
    field = meshgrow.SizeField()
    field.add_fixed([model], [model], 0.3, 1.2, 0.5)
    field.combine(count)
    field.generate(3)
    assert {1, 2, 3} <= count.dims


def test_the_users_sizes_are_combined_in_the_plain_way_too():
    model, field = square_with_a_fine_side()
    field.combine(five(0.05))
    field.register()
    gmsh.model.mesh.generate(2)
    assert element_count(model.face) > 3000


@pytest.mark.parametrize("threads", [1, 4])
@pytest.mark.parametrize("kind", [ValueError, KeyboardInterrupt])
def test_an_exception_from_the_users_sizes_is_raised_by_generate(kind, threads):
    model, field = square_with_a_fine_side()

    def fails(dim, tag, x, y, z, lc):
        raise kind("no size today")
    field.combine(fails)
    with options(General_NumThreads=threads):
        with pytest.raises(kind, match="no size today"):
            field.generate(2)
    field.combine(None)
    field.generate(2)
    assert has_elements(model.face)


@pytest.mark.parametrize("wrong", [3, "size", lambda x, y: 1.0])
def test_what_is_no_size_callback_is_refused(wrong):
    _, field = square_with_a_fine_side()
    with pytest.raises(ValueError, match="dim, tag, x, y, z"):
        field.combine(wrong)
