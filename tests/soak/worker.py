"""Meshes random models in one process and tells of each: python worker.py MODE PIPE LIMIT SEED...

MODE is "field" (meshed by SizeField.generate), "callback" (in Gmsh's own order, by the sizes of the
field) or "plain" (Gmsh alone, with sizes alike). To the file descriptor PIPE go lines of JSON:
{"asked": seed} as the library is asked, then the result. A model may take LIMIT seconds of the
processor (not of the clock: that would depend on what else runs), then SIGXCPU ends it."""

import ctypes
import json
import os
import re
import resource
import signal
import sys
import time
import traceback

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python"))

import gmsh  # noqa: E402

from checks import Before, flat_tetrahedra, invalid, measure_volumes  # noqa: E402
from meshes import boundary, closure, element_count, options  # noqa: E402
from soak_model import GmshFailure, SoakModel  # noqa: E402


def resident_megabytes():
    """After the allocator has given back what it does not need."""
    ctypes.CDLL(None).malloc_trim(0)
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def tetrahedra():
    return sum(element_count(v) for v in gmsh.model.getEntities(3))


def unmeshed_volumes():
    return [v for v in gmsh.model.getEntities(3) if not element_count(v)]


def mesh_without(model, generate):
    """Whether Gmsh fails in its own order with sizes alike, up to a factor."""
    for factor in (1.0, 0.9, 1.1, 0.8, 1.25):
        try:
            generate(factor)
            message = "%s left without a mesh" % unmeshed_volumes() if unmeshed_volumes() else ""
        except Exception as error:
            message = str(error)
        if message:
            return {"status": "gmsh", "message": "sizes times %g: %s" % (factor, message)}
        gmsh.model.mesh.clear()
        model.mesh_beforehand()
    return {"status": "meshed"}


def fails_on_same_faces():
    """Why Gmsh alone cannot mesh the volumes without a mesh either, from the meshes of their faces;
    empty if it can, or if a face has none."""
    empty = unmeshed_volumes()
    if not all(element_count(face) for face in boundary(empty)):
        return ""
    try:
        with options(Mesh_MeshOnlyVisible=1, Mesh_Renumber=0):
            gmsh.model.setVisibility(gmsh.model.getEntities(), 0)
            gmsh.model.setVisibility(empty, 1)
            gmsh.model.mesh.generate(3)
    except Exception as error:
        return str(error)
    return "%s left without a mesh" % unmeshed_volumes() if unmeshed_volumes() else ""


def mesh_by_field(model):
    before = Before()
    result = {"status": "meshed"}
    try:
        field = model.make_field()
        field.generate(3)
    except Exception as error:
        result = {"status": "error", "kind": type(error).__name__, "message": str(error)}
    result["differences"] = before.differences()
    result["premeshed"] = len(before.meshes)
    if result["status"] == "error":
        result["same_faces"] = fails_on_same_faces()
        named = re.findall(r"Curve (\d+)", result["message"].partition(" other elements")[0])
        result["meshed_before"] = all((1, int(tag)) in before.meshes for tag in named)
    if result["status"] == "meshed":
        result["invalid"] = invalid()
        result["flat"] = flat_tetrahedra()
        result["tetrahedra"] = tetrahedra()
        result["seconds_of"] = field.statistics()["seconds"]
        result["volumes"] = measure_volumes(field, closure(before.meshes))
    return result


def run(mode, seed, tell=lambda line: None):
    start = time.monotonic()
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    words = []
    try:
        model = SoakModel(seed)
        words = model.words
        model.set_options()
        model.mesh_beforehand()
        tell({"asked": seed})
        result = {"field": mesh_by_field,
                  "callback": lambda model: mesh_without(model, model.generate_by_callback),
                  "plain": lambda model: mesh_without(model, model.generate_without)}[mode](model)
    except GmshFailure as failure:
        result = {"status": "gmsh", "message": "before the library: %s" % failure}
    except Exception:
        result = {"status": "mistake", "message": traceback.format_exc(limit=-2)}
    gmsh.finalize()
    return dict(result, seed=seed, words=words, seconds=round(time.monotonic() - start, 3))


def main():
    mode, (pipe, limit, *seeds) = sys.argv[1], map(int, sys.argv[2:])
    with os.fdopen(pipe, "w", buffering=1) as lines:
        def tell(line):
            lines.write(json.dumps(line) + "\n")
        for seed in seeds:
            used = resource.getrusage(resource.RUSAGE_SELF)
            limit_time = int(used.ru_utime + used.ru_stime) + limit
            resource.setrlimit(resource.RLIMIT_CPU, (limit_time, resource.RLIM_INFINITY))
            signal.alarm(100 * limit)  # if it waits for something
            result = run(mode, seed, tell)
            result["resident"] = resident_megabytes()
            tell(result)


if __name__ == "__main__":
    main()
