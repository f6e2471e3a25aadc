"""Figures 6 and 12 of the paper: a volume grows from a face mesh that comes from a file.

Face "A" was meshed by another program, finely around a point and along an edge, and comes as .msh,
.stl, .unv or GAMBIT's .neu. It has no geometry that it could be meshed again from: Gmsh keeps it as
a discrete surface, node by node. The volume is made from it in two ways (section 5.3 of the paper):

    bounded   plane faces close a block below A
    swept     A is moved along a path, straight down and then around a bend

Only a plane face may have discrete curves on its boundary, since Gmsh interpolates no other face
between them. So the path begins straight, and what the straight piece ends with is a copy of the
boundary, made of splines, for the bend to begin with.

A .msh and a .unv file have the boundary curves of A, an .stl and a .neu only triangles. Their
corners are found here, and not by Gmsh's classifySurfaces, which leaves a segment of length zero on
the boundary if it begins at a corner. Gmsh before 4.12 writes .neu files, but cannot read them;
later ones read volumes, and faces only as boundary conditions of one, which is thrown away here.
"""

import collections
import math
import os

import gmsh
import meshgrow
import numpy as np

import example_tools as tools
from example_tools import COARSE
from page import cases

GROWTH_RATE = 1.2
SIZE_LIMIT = 5.0  # never reached
FORMATS = (".msh", ".stl", ".unv", ".neu")
FACE_FILE = "imported_face_A"
SHARP_CORNER = 40  # degrees that the boundary of A turns by
DEPTH = 3.0  # of the block
STRAIGHT, BEND_AXIS = 1.5, 5.2  # length of the path's first piece; x of the axis of its bend

# A curve on the boundary of a face: signed tag, corners where it begins and ends, places of nodes.
Side = collections.namedtuple("Side", "curve start end nodes")


# -- the other program

def size_on_face(dim, tag, x, y, z, *proposed):
    """Fine around the point (1, 1) and along the edge y = 3."""
    around_point, along_edge = 0.03 + 0.15 * math.hypot(x - 1, y - 1), 0.05 + 0.15 * (3 - y)
    return COARSE * min(around_point, along_edge, 0.3)


def write_face_files():
    """Makes A, a bent face, on a pad below it, meshes both, and writes A in each format."""
    gmsh.model.add("other program")
    occ = gmsh.model.occ
    profile = occ.addBSpline([occ.addPoint(x, 0, z) for x, z in
                              ((0, 0), (1.3, 0.9), (2.6, -0.9), (4, 0))])
    face = occ.extrude([(1, profile)], 0, 3, 0)[1]
    pad = next(entity for entity in occ.extrude([face], 0, 0, -0.4) if entity[0] == 3)
    occ.synchronize()
    gmsh.model.mesh.setSizeCallback(size_on_face)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    gmsh.model.mesh.generate(3)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
    gmsh.model.mesh.removeSizeCallback()

    # In a .neu, a face is a boundary condition of a volume, and goes by its physical name.
    for entity, name in ((face, "A"), (pad, "pad")):
        group = gmsh.model.addPhysicalGroup(entity[0], [entity[1]])
        gmsh.model.setPhysicalName(entity[0], group, name)
    tools.write(FACE_FILE + ".neu")
    # The other files have the face alone, with its curves and points.
    gmsh.model.removePhysicalGroups()
    curves = tools.boundary([face])
    kept = {face, *curves, *tools.boundary(curves)}
    for dim in (3, 2, 1, 0):
        gmsh.model.removeEntities([one for one in gmsh.model.getEntities(dim) if one not in kept])
    for ending in (".msh", ".stl", ".unv"):
        tools.write(FACE_FILE + ending)
    gmsh.model.remove()


# -- reading it

def places():
    """{tag of a node: its coordinates}, of all nodes of the current model."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    return dict(zip(tags.tolist(), map(tuple, np.reshape(coordinates, (-1, 3)).tolist())))


def triangles_of(face):
    """Tags of the three nodes of each triangle of a face."""
    return np.reshape(gmsh.model.mesh.getElementsByType(2, face)[1], (-1, 3)).tolist()


def corner_paths(triangles, place):
    """The boundary of the triangles as paths of nodes from corner to corner, in their order."""
    # Undirected: triangles from a .neu look to either side.
    count = collections.Counter(
        frozenset(edge) for t in triangles for edge in zip(t, t[1:] + t[:1]))
    beside = collections.defaultdict(list)
    for edge in (edge for edge, times in count.items() if times == 1):
        for node in edge:
            beside[node] += edge - {node}
    ring = [min(beside), min(beside[min(beside)])]
    while len(ring) < len(beside):
        ring += set(beside[ring[-1]]) - {ring[-2]}
    assert len(set(ring)) == len(beside) and ring[0] in beside[ring[-1]], "A has a hole"

    way = np.diff([place[node] for node in ring[-1:] + ring + ring[:1]], axis=0)
    way /= np.linalg.norm(way, axis=1)[:, None]
    cosine = np.sum(way[:-1] * way[1:], axis=1)  # of the angle at each node of the ring
    corners = np.flatnonzero(cosine < math.cos(math.radians(SHARP_CORNER))).tolist()
    ring = ring[corners[0]:] + ring[:corners[0] + 1]
    cuts = [corner - corners[0] for corner in corners] + [len(ring) - 1]
    return [ring[begin:end + 1] for begin, end in zip(cuts, cuts[1:])]


def add_boundary(face):
    """Makes discrete curves and points of the boundary of a face; returns the face, made anew with
    the nodes and triangles that it had."""
    place, triangles = places(), triangles_of(face)
    paths = corner_paths(triangles, place)
    gmsh.model.removeEntities(gmsh.model.getEntities())
    points = {path[0]: gmsh.model.addDiscreteEntity(0) for path in paths}
    for node, point in points.items():
        gmsh.model.setCoordinates(point, *place[node])
    curves = [gmsh.model.addDiscreteEntity(1, -1, [points[path[0]], points[path[-1]]])
              for path in paths]
    face = gmsh.model.addDiscreteEntity(2, -1, curves)
    used = sorted({node for triangle in triangles for node in triangle})
    gmsh.model.mesh.addNodes(2, face, used, np.ravel([place[node] for node in used]))
    for node, point in points.items():
        gmsh.model.mesh.addElementsByType(point, 15, [], [node])
    for path, curve in zip(paths, curves):
        gmsh.model.mesh.addElementsByType(curve, 1, [], np.ravel(list(zip(path, path[1:]))))
    gmsh.model.mesh.addElementsByType(face, 2, [], np.ravel(triangles))
    gmsh.model.mesh.reclassifyNodes()
    return face


def shape_of(face):
    """Triangles of a face, each the places of its three nodes: Gmsh
    numbers nodes anew, and puts triangles in another order."""
    place = places()
    return [tuple(place[node] for node in triangle) for triangle in triangles_of(face)]


def import_face(ending):
    """Reads A into a new model; returns it, and its triangles as Gmsh had them after reading."""
    gmsh.model.add("imported" + ending)
    gmsh.merge(os.path.join(tools.OUT, FACE_FILE + ending))
    volumes = gmsh.model.getEntities(3)
    gmsh.model.removeEntities(volumes)
    gmsh.model.geo.remove(volumes)  # or they come back as soon as faces are added
    (_, face), = gmsh.model.getEntities(2)
    as_read = shape_of(face)
    if not gmsh.model.getEntities(0):
        face = add_boundary(face)
    return face, as_read


def readable_formats():
    """Those that this Gmsh reads; the others are told."""
    found = []
    for ending in FORMATS:
        try:
            import_face(ending)
            found.append(ending)
        except Exception as error:  # the class that Gmsh throws
            print("   Gmsh %s does not read %s files (%s)" % (
                gmsh.option.getString("General.Version"), ending, str(error).split(": ")[-1]))
        gmsh.model.remove()
    return found


# -- the volume

def sides_of(face):
    """The curves around a face, one after the other."""
    place = places()
    left = [curve for _, curve in gmsh.model.getBoundary([(2, face)], oriented=False)]
    sides = []
    while left:
        for curve in left:
            ends = [point for _, point in gmsh.model.getBoundary([(1, curve)], combined=False,
                                                                 oriented=False)]
            if not sides or sides[-1].end in ends:
                break
        left.remove(curve)
        segments = np.reshape(gmsh.model.mesh.getElements(1, curve)[2][0], (-1, 2))
        nodes = np.array([place[node] for node in [*segments[:, 0], segments[-1, 1]]])
        if sides and sides[-1].end != ends[0]:
            sides.append(Side(-curve, ends[1], ends[0], nodes[::-1]))
        else:
            sides.append(Side(curve, ends[0], ends[1], nodes))
    return sides


def close_below(face):
    """Plane faces around a block between A and a plane below it; returns the volume."""
    geo = gmsh.model.geo
    sides = sides_of(face)
    below = {side.start: geo.addPoint(*side.nodes[0][:2], -DEPTH) for side in sides}
    upright = {point: geo.addLine(point, lower) for point, lower in below.items()}
    bottom = [geo.addLine(below[side.start], below[side.end]) for side in sides]
    faces = [geo.addPlaneSurface([geo.addCurveLoop(
        [side.curve, upright[side.end], -line, -upright[side.start]])])
        for side, line in zip(sides, bottom)]
    faces.append(geo.addPlaneSurface([geo.addCurveLoop(bottom)]))
    volume = geo.addVolume([geo.addSurfaceLoop([face] + faces)])
    geo.synchronize()
    return volume


def sweep_piece(sides, moved, path, add_surface):
    """Moves sides along a piece of a path: `moved` gives places at its end, `path` adds the curve
    between two points and their places, `add_surface` the face within a loop of curves.
    Returns the sides at the end, and the faces between."""
    geo = gmsh.model.geo
    ends = {side.start: geo.addPoint(*moved(side.nodes[:1])[0]) for side in sides}
    paths = {side.start: path(side.start, ends[side.start], side.nodes[0]) for side in sides}
    new_sides, faces = [], []
    for side in sides:
        nodes = moved(side.nodes)
        start, end = ends[side.start], ends[side.end]
        spline = geo.addSpline([start, *(geo.addPoint(*node) for node in nodes[1:-1]), end])
        new_sides.append(Side(spline, start, end, nodes))
        faces.append(add_surface([geo.addCurveLoop(
            [side.curve, paths[side.end], -spline, -paths[side.start]])]))
    return new_sides, faces


def sweep(face):
    """Sweeps A down and around a quarter of a circle; returns the volume."""
    geo = gmsh.model.geo
    axis = np.array([BEND_AXIS, 0, -STRAIGHT])
    quarter_turn = np.array([[0, 0, -1], [0, 1, 0], [1, 0, 0]])
    down, around_down = sweep_piece(
        sides_of(face), lambda nodes: nodes - [0, 0, STRAIGHT],
        lambda start, end, place: geo.addLine(start, end), geo.addPlaneSurface)
    turned, around_bend = sweep_piece(
        down, lambda nodes: axis + (nodes - axis) @ quarter_turn.T,
        lambda start, end, place: geo.addCircleArc(
            start, geo.addPoint(axis[0], place[1], axis[2]), end), geo.addSurfaceFilling)
    end = geo.addSurfaceFilling([geo.addCurveLoop([side.curve for side in turned])])
    volume = geo.addVolume([geo.addSurfaceLoop([face, *around_down, *around_bend, end])])
    geo.synchronize()
    return volume


SHAPES = {
    "bounded": (close_below, "Volume bounded by an imported face", FORMATS,
                "y = 1 through the point where A is finest", ("--plane", "0,1,0,0,-1,0")),
    "swept": (sweep, "Volume swept from an imported face", (".stl",),
              "y = 1 through the point where A is finest", ("--plane", "0,1,0,0,-1,0")),
}


# -- meshing it

def distance_moved(before, after):
    """The farthest that one of these places is from the closest place after."""
    after = np.array(sorted(after))
    return max((np.linalg.norm(after - place, axis=1).min() for place in before), default=0.0)


def mesh_path(shape, variant):
    """Where a mesh is written."""
    return os.path.join(tools.OUT, "imported_face_%s_%s.msh" % (shape, variant.replace(" .", "_")))


def make_mesh(shape, ending, with_size_function, case):
    """Meshes the volume from A as a file has it; returns the numbers of the table."""
    name = "with %s" % ending if with_size_function else "without"
    print("-- %s, %s" % (shape, name), flush=True)
    face, as_read = import_face(ending)
    volume = SHAPES[shape][0](face)
    asked = meshgrow.SizeField(calibrate=True)
    asked.add_mesh(sources=[(2, face)], attach=[(3, volume)], growth_rate=GROWTH_RATE,
                   size_limit=SIZE_LIMIT)
    seconds = None
    if with_size_function:
        tools.generate(asked, name)
    else:
        seconds = tools.generate_by_gmsh()  # keeps A as well: it is discrete
        asked.refresh()

    report = meshgrow.report(3, [(3, volume)], asked)
    row = dict(report)
    imported = {place for triangle in as_read for place in triangle}
    now = set(places().values())
    row["imported"] = len(imported)
    row["moved"] = distance_moved(imported - now, now)
    row["same_triangles"] = collections.Counter(shape_of(face)) == collections.Counter(as_read)
    row["largest_asked"] = asked.exact_size(3, volume, sorted(now)).max()
    path = tools.write(os.path.basename(mesh_path(shape, name)))
    case.add(name, "mesh size function on A (%s)" % ending if with_size_function else "Gmsh alone",
             mesh=path, report=report,
             field=asked if with_size_function else None, seconds=seconds,
             facts={"imported nodes": len(imported), "moved": row["moved"], "format": ending,
                    "largest size asked for": round(row["largest_asked"], 2)})
    gmsh.model.remove()
    return row


def make_case(shape, readable):
    """Meshes a volume without and with; returns {variant: numbers} and the pictures."""
    _, title, endings, cut, view = SHAPES[shape]
    unread = [ending for ending in FORMATS if ending not in readable]
    case = cases.Case(
        "imported_face", shape, title=title, figures="Figures 6 and 12",
        about="Face A, on top, comes from a file and is kept, node by node. Gmsh's own sizes jump "
              "below its fine places; with a mesh size function on A they grow by 1.2 all through "
              "the volume, as the limit of %g is never reached. The cut is at %s.%s" % (
                  SIZE_LIMIT, cut, " This Gmsh does not read %s." % ", ".join(unread)
                  if unread else ""),
        premeshed="face A, meshed by another program, finely around a point and along an edge",
        measured="the volume")
    endings = [ending for ending in endings if ending in readable]
    rows = {"without": make_mesh(shape, endings[0], False, case)}
    for ending in endings:
        rows["with " + ending] = make_mesh(shape, ending, True, case)
    after = "with " + endings[0]
    case.draw("surface", "without", after, "--dim", "2", "--view", "300,0,30")
    case.draw("cut", "without", after, *view)
    case.draw_histogram("without", after, dim=3)
    return rows, case.save()


def show_table(rows):
    """Prints the numbers, a line for each mesh."""
    print("\n%-22s | tetrahedra  ratio 99 %%   max  length/size  long | nodes of A  moved  "
          "triangles  largest size asked" % "volume")
    for (shape, variant), row in rows.items():
        print("%-8s %-13s | %10d %11.2f %5.2f %12.2f %3.0f %% | %10d %6g  %9s  %18.2f" % (
            shape, variant, row["elements"], row["ratio_99"], row["ratio_max"],
            row["length_median"], 100 * row["length_share_over_2"], row["imported"], row["moved"],
            "same" if row["same_triangles"] else "CHANGED", row["largest_asked"]))
    print("\nratio: size of the larger of two neighbours over the smaller; length/size: edge "
          "length\nover the size asked for, median; long: edges longer than twice that size; "
          "moved: the farthest that\na node of A is from where Gmsh had it just after reading")


def main():
    gmsh.initialize()
    tools.start("imported_face")
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    write_face_files()
    readable = readable_formats()
    rows, files = {}, []
    for shape in SHAPES:
        made, pictures = make_case(shape, readable)
        rows.update(((shape, variant), row) for variant, row in made.items())
        files += [mesh_path(shape, variant) for variant in made] + pictures
    show_table(rows)
    tools.show_files(files)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
