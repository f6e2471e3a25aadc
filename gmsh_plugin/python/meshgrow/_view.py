"""Size fields as views of Gmsh and as files of other programs."""

from __future__ import annotations

import ctypes
import operator
import os
from typing import Any, Callable, Optional, Union

import numpy as np

from ._library import DimTag, Doubles, c_path, c_text, doubles, lib

_AXES = {"x": 0, "y": 1, "z": 2}
_EVERYWHERE = (-1, 0)


def _dim_tag(entity: Optional[DimTag]) -> DimTag:
    if entity is None:
        return _EVERYWHERE
    dim, tag = entity
    dim, tag = operator.index(dim), operator.index(tag)
    if not (0 <= dim <= 3 and abs(tag) < 2**31):
        raise ValueError("an entity is a pair of dimension (0 to 3) and tag, not %r" % (entity,))
    return dim, tag


def _point_and_normal(plane: Any) -> Doubles:
    """Six numbers of a plane: ``"x=0.5"``, or a pair of point and normal."""
    if isinstance(plane, str):
        axis, _, value = plane.replace(" ", "").partition("=")
        try:
            numbers = np.zeros(6)
            numbers[_AXES[axis]] = float(value)
            numbers[3 + _AXES[axis]] = 1.0
            return numbers
        except (KeyError, ValueError):
            raise ValueError('plane must be such as "x=0.5", or a point and a normal, not %r'
                             % (plane,)) from None
    numbers = np.ascontiguousarray(plane, dtype=np.float64).reshape(-1)
    if numbers.shape != (6,):
        raise ValueError("plane must be a point and a normal, three numbers each, not %r"
                         % (plane,))
    return numbers


def add_view(call: Callable[..., None], name: str, kind: str, entity: Optional[DimTag], plane: Any,
             resolution: Optional[int]) -> int:
    """See SizeField.add_view; `call` makes a call of the field's."""
    numbers = None if plane is None else _point_and_normal(plane)
    tag = ctypes.c_int()
    call(lib.meshgrow_field_add_view, c_text(name), c_text(kind), *_dim_tag(entity),
         None if numbers is None else doubles(numbers),
         0 if resolution is None else operator.index(resolution), ctypes.byref(tag))
    return tag.value


def write_view(call: Callable[..., None], path: Union[str, os.PathLike[str]],
               entity: Optional[DimTag]) -> int:
    """See SizeField.write_view."""
    cells = ctypes.c_size_t()
    call(lib.meshgrow_field_write_view, c_path(path), *_dim_tag(entity), ctypes.byref(cells))
    return cells.value
