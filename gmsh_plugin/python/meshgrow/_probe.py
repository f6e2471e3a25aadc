"""What decides a size: which function, and which facet of which entity."""

from __future__ import annotations

import json
from typing import Any, Callable, Dict

import numpy.typing as npt

from ._library import doubles, lib, points_array


def probe(text: Callable[..., str], dim: int, tag: int, point: npt.ArrayLike) -> Dict[str, Any]:
    """See :meth:`SizeField.probe`; `text` makes a call of the field's that returns a text."""
    array = points_array(point)
    if len(array) != 1:
        raise ValueError("give one point of three coordinates, not %d" % len(array))
    found = json.loads(text(lib.meshgrow_field_probe_json, dim, tag, doubles(array)))
    for owner in (found, found["facet"] or {}):
        if owner.get("entity") is not None:
            owner["entity"] = tuple(owner["entity"])
    return found  # type: ignore[no-any-return]
