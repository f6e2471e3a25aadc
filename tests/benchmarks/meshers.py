"""Tries each of Gmsh's meshers on a small model with a size field and says what each does with it.

Run it with each Python whose Gmsh is to be tried, with meshgrow on the path:

    PYTHONPATH=build/python python3 tests/benchmarks/meshers.py            a Markdown table
    PYTHONPATH=build/python python3 tests/benchmarks/meshers.py --json     the rows, for merging
    python3 tests/benchmarks/meshers.py --merge a.json b.json              one table out of several

Each mesher runs in a process of its own. Nothing is calibrated. The columns:

    callbacks per element   how often Gmsh asked for a size on the entity measured
    size ratio, 99 %        larger over smaller size of neighbours; 99 % of the pairs are below
    length/size             edge length / size asked for: median, and share within 1/1.41 … 1.41
    verdict                 follows: the edges are as long as asked, up to a constant factor;
                            ignores the field: they are not, or Gmsh hardly asked on that entity;
                            crashes by itself: so does the same model without any size field
"""

import argparse
import json
import sys

import gmsh

import mesher_trials as trials

CASES = {2: "square, growth 1.1", 3: "box around a sphere, growth 1.2"}
TIMEOUT = 60  # seconds
HARDLY = 0.01  # callbacks per element; those that follow have 0.1 … 25
FOLLOWS_FROM = 0.5  # share of good edges; meshers that follow have 0.5 … 1.0, others next to 0

# ==== The child ====


def child(request):
    mesher = trials.Mesher(*request["mesher"])
    trials.start(mesher)
    entity, field = trials.make_case(CASES[mesher.dim], mesher.dim)
    calls = [0]

    def told(dim, tag, x, y, z, *_):
        calls[0] += (dim, tag) == tuple(entity)
        size = field.size(dim, tag, [(x, y, z)])[0]
        return size if size < trials.NO_SIZE else trials.NO_SIZE

    if request["with_field"]:
        gmsh.model.mesh.setSizeCallback(told)
    else:
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.1)
    gmsh.model.mesh.generate(mesher.dim)
    result = trials.measure(entity, field)
    result["calls"] = calls[0] / result["elements"]
    print(json.dumps(result))


# ==== The table ====


def row_of(mesher):
    """What one mesher did, as a dictionary."""
    row = {"dim": mesher.dim, "algorithm": mesher.algorithm, "name": mesher.name,
           "gmsh": trials.gmsh_version()}
    answer = trials.run_child(__file__, {"mesher": mesher, "with_field": True}, TIMEOUT)
    if "failed" in answer:
        plain = trials.run_child(__file__, {"mesher": mesher, "with_field": False}, TIMEOUT)
        what = answer["failed"]
        if "failed" in plain:
            row["verdict"] = what + ("; by itself: the same without any field"
                                     if plain["failed"] == what else
                                     "; without any field: " + plain["failed"])
        else:
            row["verdict"] = what + "; meshes without any field"
        return row
    row.update(answer)
    row["verdict"] = verdict(row)
    return row


def verdict(row):
    if row["calls"] == 0:
        return "ignores the field: never asks for a size"
    if row["calls"] < HARDLY:
        return "ignores the field: hardly asks, goes by the boundary's mesh"
    if row["good"] < FOLLOWS_FROM:
        return "ignores the field"
    return "follows"


def print_markdown(rows):
    print("| mesher | number | Gmsh | callbacks per element | size ratio, 99 % "
          "| length/size, median | good | verdict |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for row in sorted(rows, key=lambda row: (row["dim"], row["algorithm"], len(row["gmsh"]),
                                             row["gmsh"])):
        numbers = ["-"] * 4
        if "median" in row:
            numbers = ["%.2g" % row["calls"], "%.2f" % row["ratio_99"], "%.2f" % row["median"],
                       "%.0f %%" % (100 * row["good"])]
        print("| " + " | ".join(["%dD %s" % (row["dim"], row["name"]), str(row["algorithm"]),
                                 row["gmsh"]] + numbers + [row["verdict"]]) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="print rows as JSON")
    parser.add_argument("--merge", nargs="+", metavar="FILE", help="print one table of such rows")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        child(json.loads(arguments.child))
        return
    if arguments.merge:
        rows = []
        for name in arguments.merge:
            with open(name) as file:
                rows += json.load(file)
    else:
        rows = []
        for mesher in trials.MESHERS:
            if mesher.dim > 1:
                print("   %dD %s" % (mesher.dim, mesher.name), file=sys.stderr, flush=True)
                rows.append(row_of(mesher))
    if arguments.json:
        print(json.dumps(rows, indent=1))
    else:
        print_markdown(rows)


if __name__ == "__main__":
    main()
