"""Edge lengths with and without calibration in three models of some size.

Run it with each Python whose Gmsh is to be measured, with meshgrow on the path:

    PYTHONPATH=build/python python3 tests/benchmarks/calibration_bars.py [sphere figure8 assembly]

For each model (a sphere in a box; the boxes of Figure 8; the assembly as1-tu-203.stp) and each of
Delaunay and HXT it prints, without and with `calibrate`: tetrahedra, the median of edge length /
size asked for, the share of edges within 1/1.41 … 1.41 of it, the 99 % ratio of neighbours' sizes and
the seconds of meshing. The promise: a median from 0.95 to 1.05 and 94 % of the edges.
"""

import os
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path[:0] = [os.path.join(ROOT, "tests", "python"), os.path.join(ROOT, "examples")]

import gmsh  # noqa: E402
import meshgrow  # noqa: E402

import assembly  # noqa: E402
import figure8  # noqa: E402
import meshes  # noqa: E402
import models  # noqa: E402

ALGORITHMS = {"Delaunay": 1, "HXT": 10}


def sphere(calibrate):
    model = models.sphere_in_box(6.0)
    meshes.premesh([model.sphere], lambda x, y, z: 0.09 + 0.06 * z)
    field = meshgrow.SizeField(calibrate=calibrate)
    field.add_mesh([model.sphere], [model.outer], 1.2, 2.0)
    return field, {"outer": [model.outer]}


def boxes(calibrate):
    gmsh.model.add("figure8")
    inner, outer, common = figure8.build_geometry()
    figure8.premesh(common)
    field = meshgrow.SizeField(calibrate=calibrate)
    field.add_mesh(common, [inner, outer], figure8.GROWTH_RATE, figure8.SIZE_LIMIT)
    return field, {"outer": [outer], "inner": [inner]}


def bolted_plates(calibrate):
    gmsh.model.add("assembly")
    os.makedirs(assembly.tools.OUT, exist_ok=True)
    gmsh.option.setNumber("Mesh.MeshSizeMax", assembly.SIZE_LIMIT)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 12)
    plates, bolts = assembly.build_geometry()
    shared = sorted(set(assembly.tools.surfaces_of(plates)) &
                    set(assembly.tools.surfaces_of(bolts)))
    field = meshgrow.SizeField(calibrate=calibrate)
    field.add_fixed(assembly.tools.surfaces_of(bolts), bolts, assembly.BOLT_SIZE,
                    assembly.GROWTH_RATE, assembly.SIZE_LIMIT)
    field.add_mesh(shared, plates, assembly.GROWTH_RATE, assembly.SIZE_LIMIT)
    return field, {"plates": plates, "bolts": bolts}


MODELS = {"sphere": sphere, "figure8": boxes, "assembly": bolted_plates}


def measure(name, algorithm, calibrate):
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.Algorithm3D", ALGORITHMS[algorithm])
    field, parts = MODELS[name](calibrate)
    start = time.time()
    field.generate(3)
    seconds = time.time() - start
    for part, volumes in parts.items():
        report = meshgrow.report(3, volumes, field)
        print("%-8s %-6s  %-8s  %-10s  %9s  %6.3f  %6.1f %%  %5.2f  %5.1f" % (
            name, part, algorithm, "calibrated" if calibrate else "-",
            "{:,}".format(report["elements"]), report["length_median"],
            100 * report["length_share_good"], report["ratio_99"], seconds), flush=True)
    gmsh.finalize()


def main():
    names = sys.argv[1:] or list(MODELS)
    if not set(names) <= set(MODELS):
        sys.exit("error: choose from %s" % ", ".join(MODELS))
    gmsh.initialize(readConfigFiles=False)
    version = gmsh.option.getString("General.Version")
    gmsh.finalize()
    print("Gmsh %s\nmodel    part    mesher    calibrate   elements  median      good   99 %%      s"
          % version)
    for name in names:
        for algorithm in ALGORITHMS:
            for calibrate in (False, True):
                measure(name, algorithm, calibrate)


if __name__ == "__main__":
    main()
