"""Memory that stays behind: python memory.py [MODELS] [ROUNDS] [FIRST_SEED]

The same models again and again in one process, for each of four ways; a line tells the memory (heap
in use, and resident) that each model leaves behind, from the third round on. Gmsh leaks by itself;
ends with 1 if `field` leaves more of the heap than Gmsh alone does, beyond what is noise.

nothing  the geometry and its mesh beforehand, no field
sizes    a field beside that: grids, sizes, probes, its text; no meshing
gmsh     Gmsh alone
field    SizeField.generate
"""

import ctypes
import json
import subprocess
import sys

import gmsh
import numpy as np

from soak_model import SoakModel
from worker import resident_megabytes

WARM = 2  # rounds that fill caches
NOISE = 4.0  # kilobytes a model


class HeapUse(ctypes.Structure):
    """mallinfo2() of the C library."""

    _fields_ = [(name, ctypes.c_size_t) for name in (
        "arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks",
        "fordblks", "keepcost")]


def heap_kilobytes():
    mallinfo2 = ctypes.CDLL(None).mallinfo2
    mallinfo2.restype = HeapUse
    use = mallinfo2()
    return (use.uordblks + use.hblkhd) / 1e3


def use_field(model):
    field = model.make_field()
    field.refresh()
    points = np.random.default_rng(1).uniform(-1, 1, (1000, 3))
    for volume in gmsh.model.getEntities(3):
        field.size(*volume, points)
        field.exact_size(*volume, points[:100])
        field.probe(*volume, points[0])
    field.smallest_size(points)
    field.summary()


def mesh_by_gmsh(model):
    gmsh.option.setNumber("Mesh.MeshSizeMax", model.limit())
    gmsh.model.mesh.generate(3)


WAYS = {"nothing": lambda model: None, "sizes": use_field, "gmsh": mesh_by_gmsh,
        "field": lambda model: model.make_field().generate(3)}


def run(way, seed):
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    try:
        model = SoakModel(seed)
        model.set_options()
        model.mesh_beforehand()
        WAYS[way](model)
    except Exception:  # it fails in each round alike
        pass
    gmsh.finalize()


def measure(way, seeds, rounds):
    """Kilobytes per model: heap in use and resident, by a line through the rounds."""
    after = []
    for _ in range(rounds):
        for seed in seeds:
            run(way, seed)
        after.append((heap_kilobytes(), resident_megabytes() * 1e3))
    slopes = np.polyfit(np.arange(WARM, rounds), np.array(after[WARM:]), 1)[0] / len(seeds)
    return {"heap": round(slopes[0], 2), "resident": round(slopes[1], 2),
            "last": round(after[-1][1] / 1e3, 1)}


def main():
    if sys.argv[1:2] == ["--way"]:
        numbers = [int(a) for a in sys.argv[3:]]
        print(json.dumps(measure(sys.argv[2], range(numbers[2], numbers[2] + numbers[0]),
                                 numbers[1])))
        return
    arguments = sys.argv[1:] + ["12", "10", "1"][len(sys.argv) - 1:]
    left = {}
    for way in WAYS:
        output = subprocess.run([sys.executable, __file__, "--way", way] + arguments, check=True,
                                stdout=subprocess.PIPE, text=True).stdout
        result = json.loads(output.splitlines()[-1])
        left[way] = result["heap"]
        print("Gmsh %s, %-8s heap %+7.2f kB, resident %+7.2f kB a model; %5.1f MB at the end"
              % (gmsh.__version__, way, result["heap"], result["resident"], result["last"]),
              flush=True)
    if left["field"] > max(left["gmsh"], left["nothing"]) + NOISE:
        sys.exit("The library leaves memory behind: %g kB a model more than Gmsh alone."
                 % (left["field"] - left["gmsh"]))


if __name__ == "__main__":
    main()
