"""What the page says of the cases, as plain texts and links for its template."""

import os
import re
from pathlib import Path

import number_text
from picture_file import png_size

EXAMPLES = Path(os.path.abspath(__file__)).parent.parent
SOURCE_ENDINGS = (".py", ".geo", ".cpp")
PICTURE_HEADINGS = {"surface": "Surface", "cut": "Cut", "histogram": "Element sizes"}
# Which picture of a case is shown at the top, the first one that there is.
THUMBNAIL_KINDS = ("cut", "surface", "histogram")

# Heading of a column, key in the report, how it is written, the best of it, what it means.
REPORT_COLUMNS = (
    ("elements", "elements", number_text.count, None, "of what is measured: see above the table"),
    ("ratio, max", "ratio_max", number_text.ratio, min,
     "size of the larger of two neighbours over the smaller, at most; 1 is no jump"),
    ("ratio, 99\u00a0%", "ratio_99", number_text.ratio, min,
     "99 % of the neighbours have a smaller ratio; with a growth rate of 1.2, 1.2 to 1.35 is what "
     "the irregularity of a good mesh allows"),
    ("length/size", "length_median", number_text.ratio, None,
     "edge length over the size asked for there, the median; 1 is as asked for"),
    ("good, in\u00a0%", "length_share_good", number_text.percent, None,
     "share of the edges with a length/size from 1/1.41 to 1.41"),
    ("quality, worst", "gamma_min", number_text.quality, None,
     "gamma of triangles and tetrahedra, from the radii of the inscribed and the circumscribed "
     "circle or sphere; 1 is best"),
    ("quality, mean", "gamma_mean", number_text.quality, None, "the same, of all of them"),
)
TIME_COLUMNS = (
    ("seconds in\u00a0Gmsh", "gmsh", "meshing in Gmsh itself, the sizes that it asks for included"),
    ("seconds in\u00a0meshgrow", "meshgrow", "reading the meshes of sources, measuring curvature and gaps, building trees and grids"),
)
HEADINGS = [column[0] for column in REPORT_COLUMNS + TIME_COLUMNS]
MEANINGS = [(column[0], column[-1]) for column in REPORT_COLUMNS + TIME_COLUMNS] + [
    ("bold", "the smallest ratio of the case"), (number_text.UNKNOWN, "not known or not measured")]


def describe(records, out):
    """Returns the examples of the page, each with its cases, in the order of the paper's figures.

    records: read from *.case.json; out: the folder of the page
    """
    anchors = set()
    by_example = {}
    for record in records:
        by_example.setdefault(record["example"], []).append(record)
    for cases in by_example.values():
        cases.sort(key=case_order)
    ordered = sorted(by_example.items(), key=lambda item: case_order(item[1][0]))
    return [{"name": name, "anchor": new_anchor("example-" + name, anchors),
             "sources": sources(name, out),
             "cases": [describe_case(record, out, anchors) for record in cases]}
            for name, cases in ordered]


def case_order(record):
    """Sorts by the first figure of the paper that a case is about; the others follow by name.

    Within an example, cases of one figure come as it makes them.
    """
    figures = [int(digits) for digits in re.findall(r"\d+", record["figures"])]
    return (min(figures, default=1000), record["example"], record.get("position", 0),
            record["name"])


def new_anchor(text, taken):
    """Returns a name for links within the page that no other place has."""
    wanted = anchor = re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")
    number = 1
    while anchor in taken:
        number += 1
        anchor = "%s-%d" % (wanted, number)
    taken.add(anchor)
    return anchor


def sources(example, out):
    """Returns the files of an example; linked if they are in the folder above the page."""
    names = [example + ending for ending in SOURCE_ENDINGS]
    return [{"name": name, "link": "../" + name if (out.parent / name).exists() else None}
            for name in names if (EXAMPLES / name).exists()]


def describe_case(record, out, anchors):
    """Returns one case for the template."""
    fact_names = list(dict.fromkeys(name for variant in record["variants"]
                                    for name in variant["facts"]))
    pictures = [describe_picture(picture, record, out) for picture in record["pictures"]]
    by_kind = {kind: picture["file"] for kind, picture in
               zip([one["kind"] for one in record["pictures"]][::-1], pictures[::-1])}
    return {**{key: record[key] for key in ("example", "title", "figures", "about", "measured")},
            "premeshed": record["premeshed"].rstrip("."),
            "anchor": new_anchor("case-%s-%s" % (record["example"], record["name"]), anchors),
            "pictures": pictures,
            "thumbnail": next((by_kind[kind] for kind in THUMBNAIL_KINDS if kind in by_kind), None),
            "variants": [describe_variant(variant, record["variants"], fact_names, out)
                         for variant in record["variants"]]}


def describe_variant(variant, all_variants, fact_names, out):
    """Returns one row of the table, and what is said of its mesh."""
    cells = []
    for _, key, write, best_of, _ in REPORT_COLUMNS:
        texts = [write(one["report"].get(key)) for one in all_variants]
        known = [one["report"][key] for one in all_variants
                 if number_text.is_number(one["report"].get(key))]
        text = write(variant["report"].get(key))
        # By what is to be read: of two equal numbers none is better.
        best = bool(best_of and known and text == write(best_of(known)) and len(set(texts)) > 1)
        cells.append({"text": text, "best": best})
    for _, key, _ in TIME_COLUMNS:
        cells.append({"text": number_text.seconds(variant["seconds"].get(key)), "best": False})
    facts = [{"name": name, "text": number_text.fact(variant["facts"].get(name))}
             for name in fact_names]
    mesh = variant["mesh"]
    return {"title": variant["title"], "cells": cells, "facts": facts, "lines": variant["lines"], "mesh": mesh,
            "mesh_link": mesh if (out / mesh).exists() else None}


def describe_picture(picture, record, out):
    """Returns one picture; that it is there is checked by who looks at the page."""
    heading = PICTURE_HEADINGS[picture["kind"]]
    caption = picture.get("caption") or ""
    path = out / picture["file"]
    return {"file": picture["file"], "heading": heading, "caption": caption,
            "size": png_size(path) if path.exists() else None,
            "alt": "%s, before and after: %s. %s" % (heading, record["title"], caption)}
