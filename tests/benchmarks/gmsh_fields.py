"""What each of Gmsh's own ways to carry on the sizes of a given boundary mesh gives, side by side.

Run it with each Python whose Gmsh is to be measured, with meshgrow on the path:

    PYTHONPATH=build/python python3 tests/benchmarks/gmsh_fields.py             Markdown tables
    PYTHONPATH=build/python python3 tests/benchmarks/gmsh_fields.py --quick     small models

Two models: a sphere (r = 1) meshed beforehand from 0.03 to 0.15, in a box of side 6; and the boxes
of examples/figure8.py, whose common faces are meshed beforehand from 0.08 to 0.45. Measured is the
outer volume. In all rows the faces are the same and kept, the mesher is 3D Delaunay, and nothing is
larger than 2. Sizes are compared with those of growth 1.2. Each row is a process of its own: its
lines of .geo are all that differs. The columns:

    ratio max, 99 %   larger over smaller size of neighbours; 99 % of the pairs are below
    > 2               edges longer than twice the size asked for
    length/size       median of edge length / size asked for
    seconds           of meshing, once the faces are there
    lines             of input

The Threshold is tuned to the model: of five sizes on the faces, from their smallest element to
their largest, the one with the lowest 99 % ratio, at the slope of growth 1.2.
"""

import argparse
import hashlib
import json
import os
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path[:0] = [os.path.join(ROOT, "tests", "python"), os.path.join(ROOT, "examples")]

QUICK = "--quick" in sys.argv
if QUICK:
    os.environ["MESHGROW_EXAMPLES_COARSE"] = "2.5"  # read by figure8

import gmsh  # noqa: E402
import meshgrow  # noqa: E402
import numpy as np  # noqa: E402

import figure8  # noqa: E402
import meshes  # noqa: E402
import mesher_trials as trials  # noqa: E402
import models  # noqa: E402

GROWTH_RATE = 1.2
SLOPE = 1 - 1 / GROWTH_RATE
SIZE_LIMIT = 2.0
TIMEOUT = 1800  # seconds

# ==== Models: each returns (outer volume, faces meshed beforehand) ====


def sphere():
    scale = figure8.COARSE
    model = models.sphere_in_box(6.0)
    meshes.premesh([model.sphere], lambda x, y, z: scale * (0.09 + 0.06 * z))
    return model.outer, [model.sphere], [model.outer]


def boxes():
    gmsh.model.add("figure8")
    inner, outer, common = figure8.build_geometry()
    figure8.premesh(common)
    return outer, common, [inner, outer]


MODELS = {"sphere": ("A sphere in a box", sphere), "figure8": ("The boxes of Figure 8", boxes)}

# ==== Ways: each returns its lines of .geo, {} being filled in as `facts_of` says ====

NO_EXTENSION = "Mesh.MeshSizeExtendFromBoundary = 0;"


def threshold(size):
    """Lines for a Threshold whose sizes begin with `size` on the faces."""
    return ["Field[1] = Distance;", "Field[1].SurfacesList = {{{faces}}};",
            "Field[1].NumPointsPerCurve = 100;", "Field[2] = Threshold;", "Field[2].InField = 1;",
            "Field[2].SizeMin = %s;" % size, "Field[2].SizeMax = {limit};",
            "Field[2].DistMin = 0;", "Field[2].DistMax = ({limit} - %s) / {slope};" % size,
            "Background Field = 2;", NO_EXTENSION]


EXTEND = ["Field[1] = Extend;", "Field[1].SurfacesList = {{{faces}}};",
          "Field[1].SizeMax = {limit};", "Field[1].DistMax = ({limit} - {middle}) / {slope};",
          "Background Field = 1;", NO_EXTENSION]
EXTEND_ALL = [line.replace("{faces}", "{all_faces}") for line in EXTEND]
EXTEND_RATIO = ["Field[1] = Extend;", "Field[1].VolumesList = {{{volumes}}};",
                "Field[1].SizeMax = {limit};", "Field[1].Ratio = 1 + {slope};",
                "Background Field = 1;", NO_EXTENSION]
AUTOMATIC = ["Field[1] = AutomaticMeshSizeField;", "Field[1].hMax = {limit};",
             "Field[1].gradation = {growth};", "Background Field = 1;", NO_EXTENSION]
SIZE_FUNCTION = ("mesh source Surface{{{faces}}} attach Volume{{{volumes}}} "
                 "growth {growth} limit {limit}")

STEPS = 5
WAYS = {
    "nothing (`MeshSizeExtendFromBoundary` 0)": [NO_EXTENSION],
    "`MeshSizeExtendFromBoundary` 1, Gmsh's default": [],
    "`MeshSizeExtendFromBoundary` 2": ["Mesh.MeshSizeExtendFromBoundary = 2;"],
    **{"`Distance` and `Threshold`, %d" % step: threshold("{step%d}" % step)
       for step in range(STEPS)},
    "`Extend` from the faces": EXTEND,
    "`Extend` from all faces of the volume": EXTEND_ALL,
    "`Extend` of a later Gmsh, with `Ratio`": EXTEND_RATIO,
    "`AutomaticMeshSizeField`": AUTOMATIC,
    "meshgrow": [SIZE_FUNCTION],
    "meshgrow, `calibrate`": [SIZE_FUNCTION],
}


def lacks(way):
    """Why this Gmsh cannot go this way, or None."""
    version = tuple(int(part) for part in trials.gmsh_version().split("-")[0].split("."))
    if way.endswith("Boundary` 2") and version < (4, 9, 3):
        return "the value 2 came with 4.9.3"
    if "Extend` " in way and way.startswith("`Extend") and not has_option("Extend", "SizeMax"):
        return "`Extend` came with 4.9.3"
    if "Ratio" in way and not has_option("Extend", "Ratio"):
        return "this `Extend` takes `DistMax` and `Power`"
    if way.startswith("`Extend` from") and has_option("Extend", "Ratio"):
        return "this `Extend` takes a `Ratio`"
    return None


def has_option(kind, option):
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        gmsh.model.mesh.field.setNumber(gmsh.model.mesh.field.add(kind), option, 1)
        return True
    except Exception:
        return False
    finally:
        gmsh.finalize()


# ==== The child ====


def facts_of(outer, faces, volumes):
    """What the lines are filled in with."""
    tags = lambda entities: ", ".join(str(tag) for _, tag in entities)  # noqa: E731
    sizes = start_sizes(faces)
    steps = np.geomspace(sizes.min(), sizes.max(), STEPS)
    return {"faces": tags(faces), "all_faces": tags(sorted(set(meshes.boundary([outer])))),
            "volumes": tags(volumes), "limit": SIZE_LIMIT, "growth": GROWTH_RATE,
            "slope": "%.6g" % SLOPE, "middle": "%.4g" % np.median(sizes),
            **{"step%d" % i: "%.4g" % size for i, size in enumerate(steps)}}


def start_sizes(faces):
    corners = np.concatenate([meshes.corners(face, "Triangle") for face in faces])
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean(axis=1)


def read_lines(lines):
    """Lets Gmsh read lines of .geo into the model."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "lines.geo")
        with open(path, "w") as file:
            file.write("\n".join(lines) + "\n")
        gmsh.merge(path)


def child(request):
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.Algorithm3D", 1)
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE_LIMIT)
    outer, faces, volumes = MODELS[request["model"]][1]()
    facts = facts_of(outer, faces, volumes)
    lines = [line.format(**facts) for line in WAYS[request["way"]]]
    given = meshes.snapshots(faces)

    asked = meshgrow.SizeField()
    asked.add(SIZE_FUNCTION.format(**facts))
    ours = request["way"].startswith("meshgrow")
    # Without functions, the entities are meshed in the same order by Gmsh's sizes alone.
    field = meshgrow.SizeField(calibrate="calibrate" in request["way"])
    gmsh.logger.start()
    if ours:
        field.add(lines[0])
    else:
        read_lines(lines)
    begin = time.perf_counter()
    field.generate(3)
    seconds = time.perf_counter() - begin
    errors = [line for line in gmsh.logger.get() if line.startswith("Error")]
    if errors:
        sys.exit(errors[0])
    if meshes.snapshots(faces) != given:
        sys.exit("error: the faces that were meshed before were changed.")
    asked.refresh()
    report = meshgrow.report(3, [outer], asked)
    print(json.dumps({"elements": report["elements"], "ratio_max": report["ratio_max"],
                      "ratio_99": report["ratio_99"], "median": report["length_median"],
                      "over_2": report["length_share_over_2"], "seconds": seconds,
                      "lines": lines, "faces": hashlib.sha256(repr(given).encode()).hexdigest(),
                      "sizes": [float(facts["step0"]), float(facts["step%d" % (STEPS - 1)])]}))


# ==== The tables ====


def rows_of(name):
    """Each way that works, with what it gave, the Threshold only where it is best."""
    rows, left_out, thresholds = {}, [], {}
    for way in WAYS:
        print("   %s: %s" % (name, way), file=sys.stderr, flush=True)
        why = lacks(way)
        answer = {"failed": why} if why else trials.run_child(
            __file__, {"model": name, "way": way}, TIMEOUT)
        if "failed" in answer:
            left_out.append("%s: %s" % (way, answer["failed"]))
        elif "Threshold" in way:
            thresholds[way] = answer
            best = min(thresholds.values(), key=lambda row: row["ratio_99"])
            size = next(line for line in best["lines"] if "SizeMin" in line)
            title = ("`Distance` and `Threshold`, tuned: `SizeMin` %s"
                     % size.split("=")[1].strip(" ;"))
            rows = {way: row for way, row in rows.items() if "Threshold" not in way}
            rows[title] = best
        else:
            rows[way] = answer
    if len({row["faces"] for row in rows.values()}) != 1:
        sys.exit("error: the rows have not the same faces.")
    return rows, left_out


def print_table(name):
    rows, left_out = rows_of(name)
    smallest, largest = next(iter(rows.values()))["sizes"]
    print("\n%s, faces meshed beforehand from %.2g to %.2g; Gmsh %s\n" % (
        MODELS[name][0], smallest, largest, trials.gmsh_version()))
    print("| sizes from | lines | tetrahedra | ratio max | 99 % | > 2 | length/size | seconds |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for way, row in rows.items():
        print("| %s | %d | %s | %.2f | %.2f | %.1f %% | %.2f | %.1f |" % (
            way, len(row["lines"]), "{:,}".format(row["elements"]), row["ratio_max"],
            row["ratio_99"], 100 * row["over_2"], row["median"], row["seconds"]))
    for line in left_out:
        print("\nLeft out: " + line, end="")
    print(flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="small models")
    parser.add_argument("models", nargs="*", help="of %s; all, if none" % ", ".join(MODELS))
    parser.add_argument("--child", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        child(json.loads(arguments.child))
        return
    for name in arguments.models or MODELS:
        if name not in MODELS:
            sys.exit("error: there is no model '%s': choose from %s" % (name, ", ".join(MODELS)))
        print_table(name)


if __name__ == "__main__":
    main()
