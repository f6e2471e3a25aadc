"""NumPy arrays in and out of the package."""

import meshgrow
import numpy as np
import pytest

import models
from meshgrow import _field, _library


@pytest.fixture
def square():
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
    return model, field


@pytest.fixture
def passed(monkeypatch):
    """Addresses of the arrays that reach the library."""
    addresses = []

    def doubles(array):
        addresses.append(array.ctypes.data)
        return _library.doubles(array)

    monkeypatch.setattr(_field, "doubles", doubles)
    return addresses


@pytest.mark.parametrize("method", ["size", "exact_size"])
def test_contiguous_points_and_out_are_used_in_place(square, passed, method):
    model, field = square
    points = np.ascontiguousarray(np.random.default_rng(1).uniform(0, 1, (100, 3)))
    out = np.full(100, -1.0)
    result = getattr(field, method)(*model.face, points, out=out)
    assert result is out
    assert passed == [points.ctypes.data, out.ctypes.data]
    assert (out > 0).all()
    assert (out == getattr(field, method)(*model.face, points)).all()


def test_rows_of_a_larger_array_are_used_in_place(square, passed):
    model, field = square
    points, out = np.zeros((10, 3)), np.zeros(10)
    points[:, 0] = np.linspace(0, 1, 10)
    field.size(*model.face, points[4:], out=out[4:])
    assert passed == [points[4:].ctypes.data, out[4:].ctypes.data]
    assert (out[:4] == 0).all() and (out[4:] > 0).all()


@pytest.mark.parametrize("points", [
    [[0.5, 0.5, 0.0]], [0.5, 0.5, 0.0], ((0.5, 0.5, 0),), np.array([[0.5, 0.5, 0.0]], np.float32),
    np.asfortranarray([[0.5, 0.5, 0.0], [0.1, 0.1, 0]]), np.zeros((4, 6))[:, ::2] + 0.5,
    np.array([[1, 0, 0]])])
def test_everything_that_makes_points_is_taken(square, points):
    model, field = square
    expected = field.size(*model.face, np.array(points, dtype=np.float64).reshape(-1, 3))
    assert (field.size(*model.face, points) == expected).all()


def test_no_points_have_no_sizes(square):
    model, field = square
    assert field.size(*model.face, np.empty((0, 3))).shape == (0,)


@pytest.mark.parametrize("out", [
    np.empty(4), np.empty(5, np.float32), np.empty((5, 1)), np.empty(10)[::2], [0.0] * 5])
def test_an_unfit_out_is_refused(square, out):
    model, field = square
    with pytest.raises(ValueError, match="out must be"):
        field.size(*model.face, np.zeros((5, 3)), out=out)


def test_a_read_only_out_is_refused_and_read_only_points_are_taken(square):
    model, field = square
    frozen = np.zeros(1)
    frozen.flags.writeable = False
    with pytest.raises(ValueError, match="writeable"):
        field.size(*model.face, [[0, 0, 0]], out=frozen)
    points = np.zeros((1, 3))
    points.flags.writeable = False
    assert field.size(*model.face, points)[0] < 0.06
