"""Measures how long Gmsh's edges are against the sizes asked for, and how to make up for it.

Run it with each Python whose Gmsh is to be measured, with meshgrow on the path:

    PYTHONPATH=build/python python3 tests/benchmarks/calibrate.py [--mesher 1,0 --mesher 3,10]

(all meshers: about a quarter of an hour; those named are measured with the factors of those before
them, so name 1,0 and 2,6 with one of 3D)

For each mesher (dimension, algorithm) and each small model it meshes by a size field, sizes told to
Gmsh multiplied by one factor or another, and measures the median of edge length / size asked for
and the share of good edges (within 1/1.41 … 1.41). It prints

- the table for people: median and good share before (factor 1) and after (the factor chosen);
- the entries of the table in gmsh_plugin/calibration.cpp.

The factor chosen leaves the most good edges on average over the models; among equals (within 0.3 %)
the one with the median nearest to 1. In 3D a second factor holds at the boundary (among equals, the
largest): the nodes there are given, spaced by the sizes asked for and not by the smaller ones told,
which pushes the first layer of nodes away. From the boundary on, the factor rises linearly to the
one of the interior, within DEPTH sizes.
"""

import argparse
import json
import math
import sys

import gmsh
import meshgrow
import numpy as np

import mesher_trials as trials

DEPTH = 1.2  # in sizes asked for; the same number stands in gmsh_plugin/calibration.h
STEP = 0.01  # of the factors
EQUAL = 0.003  # shares of good edges as equal as that count as equal
TIMEOUT = 300  # seconds for all trials of one model

# ==== The child: one model, one mesher, several factors ====


def boundary_distance_field(volume):
    """A size field whose sizes are the distance to the boundary of the volume, meshed already."""
    field = meshgrow.SizeField(evaluator="exact", progress=lambda line: None)
    faces = gmsh.model.getBoundary([volume], oriented=False)
    # Grown at slope 1 from nothing: a size is the distance.
    field.add_fixed(faces, [volume], 1e-9, 1e9, 1e3)
    field.refresh()
    return field


def mesh(entity, field, lower, interior, boundary):
    """Meshes an entity, the sizes multiplied by factors: `lower` {dim: factor} for what bounds it,
    `interior` and `boundary` (equal but in 3D) for itself."""
    dim = entity[0]
    distances = None

    def told(dim_asked, tag, x, y, z, *_):
        size = field.size(dim_asked, tag, [(x, y, z)])[0]
        if not math.isfinite(size):
            return trials.NO_SIZE
        if dim_asked != dim:
            return lower.get(dim_asked, 1.0) * size
        if distances is None:
            return interior * size
        near = distances.size(*entity, [(x, y, z)])[0] / (DEPTH * size)
        return (boundary + (interior - boundary) * min(near, 1.0)) * size

    gmsh.model.mesh.clear()
    gmsh.model.mesh.setSizeCallback(told)
    if dim > 1:
        gmsh.model.mesh.generate(dim - 1)
    if boundary != interior:
        distances = boundary_distance_field(entity)
    gmsh.model.mesh.generate(dim)
    gmsh.model.mesh.removeSizeCallback()


def child(request):
    mesher = trials.Mesher(*request["mesher"])
    lower = {int(dim): factor for dim, factor in request["lower"].items()}
    trials.start(mesher)
    entity, field = trials.make_case(request["case"], mesher.dim)
    results = []
    for interior, boundary in request["factors"]:
        mesh(entity, field, lower, interior, boundary)
        results.append(trials.measure(entity, field))
    print(json.dumps({"results": results}))


# ==== The parent: chooses the factors ====


class Trials:
    """Results of one mesher, each (interior, boundary) pair of factors run once."""

    def __init__(self, mesher, lower):
        self.mesher, self.lower = mesher, lower
        self.results = {}  # (interior, boundary) -> {case: result}
        self.failures = {}  # case -> why

    def run(self, factors):
        factors = [f for f in factors if f not in self.results]
        for case in trials.CASES[self.mesher.dim] if factors else ():
            if case in self.failures:
                continue
            print("   %s, %s: %d meshes" % (self.mesher.name, case, len(factors)),
                  file=sys.stderr, flush=True)
            answer = trials.run_child(__file__, {
                "mesher": self.mesher, "case": case, "lower": self.lower, "factors": factors},
                TIMEOUT)
            if "failed" in answer:
                self.failures[case] = answer["failed"]
                for results in self.results.values():  # means stay over the same cases
                    results.pop(case, None)
                continue
            for factor, result in zip(factors, answer["results"]):
                self.results.setdefault(factor, {})[case] = result

    def mean(self, factors, key):
        return np.mean([result[key] for result in self.results[factors].values()])

    def best(self, candidates, tie=None):
        """Most good edges; among equals the median nearest to 1, or the smallest `tie`."""
        candidates = [c for c in candidates if c in self.results]
        most = max(self.mean(c, "good") for c in candidates)
        equal = [c for c in candidates if self.mean(c, "good") > most - EQUAL]
        return min(equal, key=tie or (lambda c: abs(math.log(self.mean(c, "median")))))


def around(middle, steps, width=1):
    return [round(middle + width * i * STEP, 2) for i in range(-steps, steps + 1)]


def calibrate(mesher, lower):
    """Returns the trials and the factors chosen, (interior, boundary); None without any result."""
    t = Trials(mesher, lower)
    t.run([(1.0, 1.0)])
    if not t.results:
        return t, None
    # A mesher that does not follow the field makes the same edges whatever the factor.
    guess = round(1.0 / t.mean((1.0, 1.0), "median"), 2)
    t.run([(guess, guess)])
    followed = abs(t.mean((guess, guess), "median") / t.mean((1.0, 1.0), "median") - 1.0)
    if followed < 0.3 * abs(guess - 1.0) and abs(guess - 1.0) > 2 * STEP:
        return t, None

    def best_interior(middle, boundary=None, steps=3, width=2):
        candidates = [(f, f if boundary is None else boundary)
                      for f in around(middle, steps, width)]
        t.run(candidates)
        return t.best(candidates)

    chosen = best_interior(best_interior(guess)[0], steps=1, width=1)
    if mesher.dim == 3:
        interior = chosen[0]
        candidates = [(interior, round(share * interior, 2))
                      for share in (1.0, 0.9, 0.8, 0.7, 0.6, 0.5)]
        t.run(candidates)
        boundary = t.best(candidates, tie=lambda c: interior - c[1])[1]
        if boundary != interior:
            chosen = best_interior(interior, boundary, steps=2, width=1)
    return t, chosen


def print_table(rows):
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(width) if i < 2 else cell.rjust(width)
                        for i, (cell, width) in enumerate(zip(row, widths))).rstrip())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--mesher", action="append", default=[], metavar="DIM,ALGORITHM",
                        help="only this mesher, such as 3,10; may be repeated")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        child(json.loads(arguments.child))
        return

    version = trials.gmsh_version()
    rows = [("mesher", "model", "elements", "median before", "after", "good before", "after")]
    entries = []
    lower = {}  # the factors of lower dimensions, measured first
    for mesher in trials.MESHERS:
        if arguments.mesher and "%d,%d" % mesher[:2] not in arguments.mesher:
            continue
        t, chosen = calibrate(mesher, lower)
        name = mesher_name(mesher)
        for case in trials.CASES[mesher.dim]:
            if case in t.failures:
                rows.append((name, case, t.failures[case], "", "", "", ""))
                continue
            before = t.results[(1.0, 1.0)][case]
            after = t.results[chosen][case] if chosen else None
            rows.append((name, case, str((after or before)["elements"]),
                         "%.3f" % before["median"], "%.3f" % after["median"] if after else "-",
                         "%.1f %%" % (100 * before["good"]),
                         "%.1f %%" % (100 * after["good"]) if after else "-"))
        if not chosen:
            why = "does not follow the field" if t.results else "no mesh"
            entries.append("    // %s, Gmsh %s: %s" % (name, version, why))
            continue
        if mesher.dim == 1:
            lower[1] = chosen[0]
        elif mesher.algorithm == 6:  # Gmsh's default, which meshes the faces of the 3D models
            lower[2] = chosen[0]
        entries.append("    {%d, %d, %.2f, %.2f},  // %s, Gmsh %s: median %.2f -> %.2f, good %.0f "
                       "-> %.0f %%" % (mesher.dim, mesher.algorithm, *chosen, mesher.name, version,
                                    t.mean((1.0, 1.0), "median"), t.mean(chosen, "median"),
                                    100 * t.mean((1.0, 1.0), "good"), 100 * t.mean(chosen, "good")))
    print("Gmsh %s; median of edge length / size asked for, good: within 1/1.41 … 1.41\n" % version)
    print_table(rows)
    print("\nEntries of gmsh_plugin/calibration.cpp: dim, algorithm, factor inside, factor at the "
          "boundary\n")
    print("\n".join(entries))


def mesher_name(mesher):
    return mesher.name if mesher.dim == 1 else "%dD %s (%d)" % (mesher.dim, mesher.name,
                                                               mesher.algorithm)


if __name__ == "__main__":
    main()
