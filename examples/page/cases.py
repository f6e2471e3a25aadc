"""What an example tells the page: a case is one model, meshed without and with a size function.

    case = cases.Case("airfoil", "naca0012", title="NACA 0012", figures="Figure 1",
                      about="One or two sentences: what is shown.",
                      premeshed="the curves, bunched at the leading edge, the shock and the tail")
    case.add("without", "Gmsh alone", mesh="before.msh", report=report_without,
             seconds={"gmsh": 1.2, "meshgrow": 0})
    case.add("with", "mesh size function", mesh="after.msh", report=report_with, field=field)
    case.draw("surface", "without", "with", "--dim", "2", "--view", "0,0,0")
    case.draw_histogram("without", "with", dim=2)
    case.save()

`save` writes <out>/<example>.<case>.case.json; make_page.py gathers them into index.html.
"""

import itertools
import json
import math
import os
import subprocess
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
OUT = os.environ.get("MESHGROW_EXAMPLES_OUT", os.path.join(os.path.dirname(FOLDER), "out"))
PICTURES_WANTED = os.environ.get("MESHGROW_EXAMPLES_PICTURES") != "0"
PICTURE_KINDS = ("surface", "cut", "histogram")
positions = itertools.count()  # of the cases of an example, in the order in which it makes them


def known(values):
    """The same dictionary with None for numbers that are none, which JSON cannot hold."""
    return {name: None if isinstance(value, float) and not math.isfinite(value) else value
            for name, value in values.items()}


class Case:
    """One model of an example.

    figures:   of the paper, as "Figures 4 and 10"; empty for others
    about:     a sentence or two: what goes wrong without, and what is seen with
    premeshed: what had a mesh before, and how it was made
    measured:  what the numbers are about, as "the outer volume"
    """

    def __init__(self, example, name, title, about, premeshed, measured, figures=""):
        self.record = {"example": example, "name": name, "title": title, "figures": figures,
                       "about": about, "premeshed": premeshed, "measured": measured,
                       "position": next(positions), "variants": [], "pictures": []}

    def add(self, name, title, mesh, report, field=None, seconds=None, facts=None):
        """Adds a mesh of the case.

        name:    short, as "without"; `draw` knows it by this
        title:   over its pictures and in the table
        mesh:    path of the file
        report:  of meshgrow.report, against the sizes asked for
        field:   that it was made with, after generate() and while its model is there: its lines of
                 text and its seconds are told
        seconds: {"gmsh": …, "meshgrow": …} where it was not made by field.generate()
        facts:   more numbers or words for the table, {"lines of input": 6, …}
        """
        # Unknown seconds are left open on the page.
        statistics = field.statistics() if field is not None else {"functions": [], "seconds": {}}
        self.record["variants"].append({
            "name": name, "title": title, "mesh": os.path.basename(mesh),
            "lines": [function["text"] for function in statistics["functions"]],
            "report": known(report), "seconds": known(seconds or statistics["seconds"]),
            "facts": known(facts or {})})

    def draw(self, kind, before, after, *options, caption=""):
        """Renders the meshes of two variants side by side, one camera and one colour scale.

        kind: "surface" or "cut"; options: of render_cut.py, as "--plane", "0,0,0,0,-1,0"
        caption: what is drawn and where to look, beside the picture
        """
        titles = [self._variant(name)["title"] for name in (before, after)]
        self._make(kind, caption, "render_cut.py", *self._meshes(before, after), "--title-before",
                   titles[0], "--title-after", titles[1], *options)

    def draw_histogram(self, before, after, dim, entities=(), caption=""):
        """Draws how many elements of `dim` (of these tags; empty: all) have which size."""
        titles = [self._variant(name)["title"] for name in (before, after)]
        of_these = ("--entities", ",".join(map(str, entities))) if entities else ()
        self._make("histogram", caption, "draw_histogram.py", *self._meshes(before, after),
                   "--title-before", titles[0], "--title-after", titles[1], "--dim", str(dim),
                   *of_these)

    def save(self):
        """Writes the case, complete or not at all; returns the paths of its pictures."""
        path = os.path.join(OUT, self._file(".case.json"))
        with open(path + ".part", "w", encoding="utf-8") as file:
            json.dump(self.record, file, indent=1, ensure_ascii=False, allow_nan=False)
        os.replace(path + ".part", path)
        return [os.path.join(OUT, picture["file"]) for picture in self.record["pictures"]]

    def _file(self, ending):
        return "%s.%s%s" % (self.record["example"], self.record["name"], ending)

    def _variant(self, name):
        return next(one for one in self.record["variants"] if one["name"] == name)

    def _meshes(self, *names):
        return [os.path.join(OUT, self._variant(name)["mesh"]) for name in names]

    def _make(self, kind, caption, script, *arguments):
        if not PICTURES_WANTED:
            return
        assert kind in PICTURE_KINDS, kind
        # A case may have several pictures of a kind.
        count = sum(picture["kind"] == kind for picture in self.record["pictures"])
        name = self._file("_%s%s.png" % (kind, count + 1 if count else ""))
        path = os.path.join(OUT, name)
        print("-- drawing %s" % os.path.relpath(path), flush=True)
        subprocess.run([sys.executable, os.path.join(FOLDER, script), *arguments, "-o", path],
                       check=True)
        self.record["pictures"].append({"kind": kind, "file": name, "caption": caption})
