"""Gradation and quality of a mesh."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Dict, Mapping, Optional

from ._library import DimTags, dim_tags, lib, take_text

if TYPE_CHECKING:
    from ._field import SizeField


def report(dim: int = 3, entities: DimTags = (),
           field: Optional[SizeField] = None) -> Dict[str, Any]:
    """Measures the current model's mesh of dimension ``dim`` (2 or 3) and returns a dictionary.

    ``entities``, a list of (dim, tag), restricts it. With a ``field``, edge lengths are compared with
    the sizes asked for at their midpoints. Element size is the mean edge length; ``ratio_…`` is the
    larger over the smaller size of neighbours. What could not be measured is None.
    """
    if field is None:
        text = take_text(lib.meshgrow_report_json(dim, *dim_tags(entities), None))
    else:
        tags = dim_tags(entities)
        text = field._text(lambda handle: lib.meshgrow_report_json(dim, *tags, handle))
    result: Dict[str, Any] = json.loads(text)
    return result


def report_table(reports: Mapping[str, Mapping[str, Any]]) -> str:
    """Several reports, a dictionary of name -> report, as a table for people."""
    rows = [{"name": name, "report": values} for name, values in reports.items()]
    return take_text(lib.meshgrow_report_table(json.dumps(rows).encode()))
