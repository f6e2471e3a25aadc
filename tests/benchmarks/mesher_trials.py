"""What calibrate.py and meshers.py share: Gmsh's meshers, small models, measuring, children.

A trial meshes one small model with one mesher, in a process of its own, so that a crash or an
endless loop of Gmsh ends that trial only.
"""

import collections
import json
import os
import subprocess
import sys

import gmsh
import meshgrow
import numpy as np

Mesher = collections.namedtuple("Mesher", "dim algorithm name recombine")

# Numbers of Mesh.Algorithm (2D) and Mesh.Algorithm3D. The last two of 2D are made for
# quadrilaterals, so their triangles are recombined.
MESHERS = [
    Mesher(1, 0, "1D", False),
    Mesher(2, 1, "MeshAdapt", False),
    Mesher(2, 2, "Automatic", False),
    Mesher(2, 5, "Delaunay", False),
    Mesher(2, 6, "Frontal-Delaunay", False),
    Mesher(2, 7, "BAMG", False),
    Mesher(2, 8, "Frontal-Delaunay for quads", True),
    Mesher(2, 9, "Packing of parallelograms", True),
    Mesher(3, 1, "Delaunay", False),
    Mesher(3, 4, "Frontal", False),
    Mesher(3, 10, "HXT", False),
]

NO_SIZE = 1e22  # what Gmsh itself takes for "no size"
GOOD = (np.sqrt(0.5), np.sqrt(2.0))  # good edges: length / size asked for within these

# ==== Models: each returns (entity to measure, source of sizes) ====


def line():
    start = gmsh.model.occ.addPoint(0, 0, 0)
    curve = gmsh.model.occ.addLine(start, gmsh.model.occ.addPoint(1.03, 0, 0))
    return (1, curve), (0, start)


def arc():
    occ = gmsh.model.occ
    start, centre = occ.addPoint(0.47, 0, 0), occ.addPoint(0, 0, 0)
    curve = occ.addCircleArc(start, centre, occ.addPoint(0, 0.47, 0))
    return (1, curve), (0, start)


def spline():
    occ = gmsh.model.occ
    points = [occ.addPoint(0.3 * i, 0.2 * (i % 2), 0.1 * i) for i in range(5)]
    return (1, occ.addSpline(points)), (0, points[0])


def square():
    face = gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    return (2, face), (1, 1)


def disc():
    face = gmsh.model.occ.addDisk(0, 0, 0, 0.6, 0.5)
    gmsh.model.occ.synchronize()
    return (2, face), (1, 1)


def cylinder_side():
    """The curved face of a cylinder, sizes from one end."""
    occ = gmsh.model.occ
    circle = occ.addCircle(0, 0, 0, 0.3)
    side = next(e for e in occ.extrude([(1, circle)], 0, 0, 1) if e[0] == 2)
    occ.synchronize()
    return side, (1, circle)


def box():
    volume = gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    return (3, volume), (2, 1)


def box_around_sphere():
    occ = gmsh.model.occ
    occ.cut([(3, occ.addBox(-1, -1, -1, 2, 2, 2))], [(3, occ.addSphere(0, 0, 0, 0.4))])
    occ.synchronize()
    volume = gmsh.model.getEntities(3)[0]
    sphere = next(f for f in gmsh.model.getBoundary([volume], oriented=False)
                  if occ.getBoundingBox(*f)[3] < 0.5)
    return volume, sphere


def plate_with_hole():
    """Six elements thick or less, so that many of its edges touch its boundary."""
    occ = gmsh.model.occ
    occ.cut([(3, occ.addBox(0, 0, 0, 2, 2, 0.25))],
            [(3, occ.addCylinder(1, 1, -1, 0, 0, 2, 0.3))])
    occ.synchronize()
    volume = gmsh.model.getEntities(3)[0]
    hole = next(f for f in gmsh.model.getBoundary([volume], oriented=False)
                if gmsh.model.getType(*f) == "Cylinder")
    return volume, hole


# dim -> {name of a case: (model, size on its source, growth rate)}
CASES = {
    1: {"line, uniform": (line, 0.0107, 1.0),
        "line, growth 1.1": (line, 0.0053, 1.1),
        "arc, growth 1.2": (arc, 0.0053, 1.2),
        "spline, growth 1.1": (spline, 0.0053, 1.1)},
    2: {"square, uniform": (square, 0.0207, 1.0),
        "square, growth 1.1": (square, 0.0103, 1.1),
        "disc, growth 1.2": (disc, 0.0067, 1.2),
        "cylinder's side, growth 1.2": (cylinder_side, 0.0103, 1.2)},
    3: {"box, uniform": (box, 0.0807, 1.0),
        "box, growth 1.2": (box, 0.0453, 1.2),
        "box around a sphere, growth 1.2": (box_around_sphere, 0.0703, 1.2),
        "plate with a hole, growth 1.1": (plate_with_hole, 0.0453, 1.1)},
}

# ==== Measuring ====


def length_ratios(entity, field):
    """Length / size asked for at the midpoint of each edge of the elements of an entity."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    position = np.zeros((int(max(tags)) + 1, 3))
    position[np.asarray(tags, dtype=int)] = np.asarray(coordinates).reshape(-1, 3)
    edges = [np.zeros((0, 2), dtype=int)]
    for kind, _, nodes in zip(*gmsh.model.mesh.getElements(*entity)):
        corners = gmsh.model.mesh.getElementProperties(kind)[3]
        nodes = np.asarray(nodes, dtype=int).reshape(-1, corners)
        if corners == 4 and entity[0] == 2:  # a quadrilateral: its sides, no diagonals
            pairs = [(0, 1), (1, 2), (2, 3), (3, 0)]
        else:
            pairs = [(i, j) for i in range(corners) for j in range(i)]
        edges += [nodes[:, pair] for pair in pairs]
    edges = np.unique(np.sort(np.concatenate(edges), axis=1), axis=0)
    ends = position[edges]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return lengths / field.size(*entity, ends.mean(axis=1))


def measure(entity, field):
    """Number of elements, median of length/size, share of good edges, 99 % size ratio."""
    ratios = length_ratios(entity, field)
    result = {
        "elements": sum(len(t) for t in gmsh.model.mesh.getElements(*entity)[1]),
        "median": float(np.median(ratios)),
        "good": float(np.mean((ratios >= GOOD[0]) & (ratios <= GOOD[1]))),
    }
    if entity[0] > 1:
        result["ratio_99"] = meshgrow.report(entity[0], [entity])["ratio_99"]
    return result


def start(mesher):
    """Starts Gmsh with a mesher and no sizes of Gmsh's own."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber("Mesh.MeshSize" + option, 0)
    if mesher.dim > 1:
        gmsh.option.setNumber("Mesh.Algorithm" + ("3D" if mesher.dim == 3 else ""),
                              mesher.algorithm)
    gmsh.option.setNumber("Mesh.RecombineAll", int(mesher.recombine))


def make_case(case, dim):
    """Builds the model of a case; returns (entity to measure, its size field)."""
    model, size, growth_rate = CASES[dim][case]
    gmsh.model.add(case)
    entity, source = model()
    gmsh.model.occ.synchronize()
    field = meshgrow.SizeField(evaluator="exact", progress=lambda line: None)
    field.add_fixed([source], [entity], size, growth_rate, 10.0)
    field.refresh()
    return entity, field


# ==== Children ====


def run_child(script, request, timeout):
    """Answer (a dict) of `script --child REQUEST`, or {"failed": why}."""
    try:
        child = subprocess.run([sys.executable, os.path.abspath(script), "--child",
                                json.dumps(request)], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, timeout=timeout)
    except subprocess.TimeoutExpired:
        return {"failed": "no end within %d s" % timeout}
    if child.returncode < 0:
        return {"failed": "crash (signal %d)" % -child.returncode}
    if child.returncode > 0 or not child.stdout.strip():
        lines = child.stderr.strip().splitlines()
        return {"failed": "error: " + (lines[-1] if lines else "no answer")}
    return json.loads(child.stdout.splitlines()[-1])


def gmsh_version():
    """As the library says: 4.8's Python module calls itself 4.8.0 in 4.8.4, too."""
    gmsh.initialize()
    version = gmsh.option.getString("General.Version")
    gmsh.finalize()
    return version
