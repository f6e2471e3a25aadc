"""What Python costs: sizes of many points at once, and size callbacks one by one.

    PYTHONPATH=build/python build/venv/bin/python tests/benchmarks/python_overhead.py [--quick]

First `field.size` on a million points beside the same call of the C function with everything
prepared, by turns; c_api_overhead measures the C function beside the C++ one. Then whole runs of
Gmsh with HXT, which asks for two sizes a tetrahedron: with the registered field, with the field as
Gmsh's callback, and with a lambda around it, by turns. Fails where sizes differ, or numbers
of tetrahedra by more than 1 %.
"""

import argparse
import os
import statistics
import sys
import time

import gmsh
import meshgrow
import numpy as np
from meshgrow import _library

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python"))
import models  # noqa: E402
from meshes import element_count, premesh  # noqa: E402


def seconds(run):
    begin = time.process_time()
    run()
    return time.process_time() - begin


def by_turns(runs, repeats):
    """Medians of the processor seconds of several functions, called by turns."""
    times = [[seconds(run) for run in runs] for _ in range(repeats + 1)]
    return [statistics.median(column) for column in zip(*times[1:])]  # the first warms up


def start():
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.Algorithm3D", 10)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.4)


def sphere_field(size, **options):
    model = models.sphere_in_box(4.0)
    premesh([model.sphere], size)
    field = meshgrow.SizeField(**options)
    field.add_mesh([model.sphere], [model.outer], 1.2, 0.4)
    return model, field


def measure_many_points(count, repeats):
    for evaluator in ("grid", "exact"):
        model, field = sphere_field(0.03, evaluator=evaluator)
        points = np.random.default_rng(1).uniform(-2, 2, (count, 3))
        out, prepared = np.empty(count), np.empty(count)
        field.refresh()
        function = _library.lib.meshgrow_field_size
        arguments = (field._handle, *model.outer, _library.doubles(points), count,
                     _library.doubles(prepared))
        into, fresh, c_call = by_turns([lambda: field.size(*model.outer, points, out=out),
                                        lambda: field.size(*model.outer, points),
                                        lambda: function(*arguments)], repeats)
        if not (out == prepared).all():
            sys.exit("error: the sizes differ")
        print("%9d points, %-5s: C %6.1f ns a point; field.size %.3f times as long, with out= %.3f"
              % (count, evaluator, 1e9 * c_call / count, fresh / c_call, into / c_call))
        gmsh.model.remove()


def measure_callbacks(size, repeats):
    is_4_8 = gmsh.option.getString("General.Version").startswith("4.8")
    model, field = sphere_field(size)
    asked = [0]

    def counted(dim, tag, x, y, z, lc=1e22):
        asked[0] += 1
        return field(dim, tag, x, y, z, lc)

    gmsh.model.mesh.setSizeCallback(counted)
    gmsh.model.mesh.generate(3)
    field.refresh()  # from here on the faces stay as they are, and so does the field

    def mesh_again():
        gmsh.model.mesh.clear([model.outer])
        gmsh.model.mesh.generate(3)

    asked[0] = 0
    mesh_again()
    calls, expected = asked[0], element_count(model.outer)

    def registered():
        field.register()
        mesh_again()
        field.unregister()

    def called():
        gmsh.model.mesh.setSizeCallback(field)
        mesh_again()

    def in_lambda():
        if is_4_8:
            gmsh.model.mesh.setSizeCallback(
                lambda dim, tag, x, y, z: min(1.0, field(dim, tag, x, y, z)))
        else:
            gmsh.model.mesh.setSizeCallback(
                lambda dim, tag, x, y, z, lc: min(1.0, field(dim, tag, x, y, z, lc)))
        mesh_again()

    times = by_turns([registered, called, in_lambda], repeats)
    if abs(element_count(model.outer) - expected) > 0.01 * expected:
        sys.exit("error: %d tetrahedra instead of %d" % (element_count(model.outer), expected))
    print("%9d sizes asked for, %d tetrahedra" % (calls, expected))
    for name, taken in zip(("register()", "setSizeCallback(field)", "lambda with the field"), times):
        print("   %-24s %6.2f s, %5.2f µs a size more than register()"
              % (name, taken, 1e6 * (taken - times[0]) / calls))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--quick", action="store_true", help="small inputs")
    quick = parser.parse_args().quick
    start()
    print("Gmsh %s" % gmsh.option.getString("General.Version"))
    measure_many_points(100000 if quick else 1000000, 3 if quick else 7)
    measure_callbacks(0.1, 1 if quick else 5)
    gmsh.finalize()


if __name__ == "__main__":
    main()
