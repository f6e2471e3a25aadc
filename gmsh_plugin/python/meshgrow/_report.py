"""Gradation and quality of a mesh."""

import json

from ._library import dim_tags, lib, take_text


def report(dim=3, entities=(), field=None):
    """Measures the current model's mesh of dimension ``dim`` (2 or 3) and returns a dictionary.

    ``entities``, a list of (dim, tag), restricts it. With a ``field``, edge lengths are compared with
    the sizes asked for at their midpoints. Element size is the mean edge length; ``ratio_…`` is the
    larger over the smaller size of neighbours. What could not be measured is None.
    """
    handle = None if field is None else field._handle
    return json.loads(take_text(lib.meshgrow_report_json(dim, *dim_tags(entities), handle)))


def report_table(reports):
    """Several reports, a dictionary of name -> report, as a table for people."""
    rows = [{"name": name, "report": values} for name, values in reports.items()]
    return take_text(lib.meshgrow_report_table(json.dumps(rows).encode()))
