"""The air above a terrain: the measured triangles are kept, the volume grows from them.

A terrain comes as triangles (terrain_stl_data.stl of Gmsh's documentation): 12 m at the summit, 230
m in the plain, 2.6 km by 2.5 km. They are the bottom of the mesh as they are, so that nothing of
what was measured is lost. A box of air is put on them, for wind: four upright faces, and a top at a
constant height. Gmsh's own sizes get from the bottom to the top within a few elements; a mesh size
function with the terrain as its source lets faces and air grow from the triangles at a chosen rate.

terrain.geo builds the same on terrain_surface.msh, which is written here. Lengths are in metres.
"""


import gmsh
import meshgrow
import numpy as np

import example_tools as tools
from page import cases

TOP = 1000  # of the air
GROWTH_RATE = 1.2
SIZE_LIMIT = 250
LINE, TRIANGLE = 1, 2  # Gmsh's types of elements


def read_triangles(name):
    """Reads an STL file; returns the coordinates of its nodes and its triangles of node numbers."""
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.model.add("STL")
    gmsh.merge(tools.find_model(name))
    nodes, coordinates, _ = gmsh.model.mesh.getNodes()
    corners = gmsh.model.mesh.getElementsByType(TRIANGLE)[1]
    gmsh.model.remove()
    order = np.argsort(nodes)
    return np.reshape(coordinates, (-1, 3))[order], np.reshape(
        np.searchsorted(nodes[order], corners), (-1, 3))


def sides_of(places, triangles):
    """The rim of a rectangular terrain as four lists of nodes, from corner to corner."""
    edges = {edge for a, b, c in triangles.tolist() for edge in ((a, b), (b, c), (c, a))}
    after = {a: b for a, b in edges if (b, a) not in edges}
    extremes = places.min(axis=0), places.max(axis=0)
    corners = {node for node in after
               if all(places[node][i] in (extremes[0][i], extremes[1][i]) for i in (0, 1))}
    assert len(corners) == 4, "the rim of the terrain is no rectangle"
    sides = []
    node = min(corners)
    while len(sides) < 4:
        side = [node]
        while len(side) == 1 or node not in corners:
            node = after[node]
            side.append(node)
        sides.append(side)
    return sides


def add_terrain(places, triangles):
    """Makes discrete points, curves and a surface, and puts the mesh on them as it is; returns the
    surface and its curves, each with the points at its ends."""
    sides = sides_of(places, triangles)
    points = {side[0]: gmsh.model.addDiscreteEntity(0) for side in sides}
    for node, point in points.items():
        gmsh.model.setCoordinates(point, *places[node])
        gmsh.model.mesh.addNodes(0, point, [node + 1], places[node])
    rim = {}
    for side in sides:
        ends = [points[side[0]], points[side[-1]]]
        curve = gmsh.model.addDiscreteEntity(1, boundary=ends)
        rim[curve] = ends
        gmsh.model.mesh.addNodes(1, curve, np.add(side[1:-1], 1), places[side[1:-1]].flatten())
        gmsh.model.mesh.addElementsByType(
            curve, LINE, [], np.add(list(zip(side, side[1:])), 1).flatten())
    terrain = gmsh.model.addDiscreteEntity(2, boundary=list(rim))
    inside = np.setdiff1d(np.arange(len(places)), np.concatenate(sides))
    gmsh.model.mesh.addNodes(2, terrain, inside + 1, places[inside].flatten())
    gmsh.model.mesh.addElementsByType(terrain, TRIANGLE, [], triangles.flatten() + 1)
    return terrain, rim


def write_terrain(places, triangles):
    """Writes the terrain alone, for terrain.geo; returns the path."""
    gmsh.model.add("terrain")
    add_terrain(places, triangles)
    path = tools.write("terrain_surface.msh")
    gmsh.model.remove()
    return path


def build_air(terrain, rim):
    """Puts a box of air on the terrain; returns its tag."""
    geo = gmsh.model.geo
    above, upright = {}, {}
    for point in sorted({point for ends in rim.values() for point in ends}):
        x, y, _ = gmsh.model.getValue(0, point, [])
        above[point] = geo.addPoint(x, y, TOP)
        upright[point] = geo.addLine(point, above[point])
    edges = {curve: geo.addLine(above[a], above[b]) for curve, (a, b) in rim.items()}
    loops = [geo.addCurveLoop([curve, upright[b], -edges[curve], -upright[a]])
             for curve, (a, b) in rim.items()]
    sides = [geo.addPlaneSurface([loop]) for loop in loops]
    top = geo.addPlaneSurface([geo.addCurveLoop(list(edges.values()))])
    air = geo.addVolume([geo.addSurfaceLoop([terrain, top, *sides])])
    geo.synchronize()
    return air


def make_mesh(case, name, title, places, triangles, with_mesh_function):
    """Meshes the air; tells the case, returns what the test needs."""
    tools.start("terrain " + name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE_LIMIT)
    terrain, rim = add_terrain(places, triangles)
    air = build_air(terrain, rim)

    field = meshgrow.SizeField(progress=tools.progress if with_mesh_function else None)
    field.add_mesh(sources=[(2, terrain)], attach=[(3, air)],
                   growth_rate=GROWTH_RATE, size_limit=SIZE_LIMIT)
    if with_mesh_function:
        tools.generate(field, "the air " + name)
        seconds = field.statistics()["seconds"]
    else:
        seconds = tools.generate_by_gmsh()  # keeps the terrain: it is discrete
        field.refresh()  # measured against only
    row = {"tags": (air, terrain), "terrain": tools.mesh_of((2, terrain)),
           "air": meshgrow.report(3, [(3, air)], field),
           "path": tools.write("terrain_%s.msh" % name)}
    case.add(name, title, row["path"], row["air"], field if with_mesh_function else None, seconds)
    gmsh.model.remove()
    return row


def main():
    gmsh.initialize()
    case = cases.Case(
        "terrain", "air", title="The air above a terrain",
        about="The triangles of the terrain are kept as they were measured, small at the summit "
              "and large in the plain. By itself, Gmsh gets from the summit to the top within a "
              "few elements. With a mesh size function, the air grows from the terrain.",
        premeshed="the terrain, a discrete surface from an STL file",
        measured="the air")
    measured = read_triangles("terrain_stl_data.stl")
    surface = write_terrain(*measured)
    rows = {"without": make_mesh(case, "without", "air by Gmsh", *measured, False),
            "with": make_mesh(case, "with", "air grown from the terrain, %g" % GROWTH_RATE,
                              *measured, True)}
    _, terrain = rows["with"]["tags"]
    case.draw("surface", "without", "with", "--dim", "2", "--volumes", str(terrain),
              "--view", "0,0,0")
    case.draw("cut", "without", "with", "--plane", "0,1800,0,0,-1,0")
    case.draw("cut", "without", "with", "--plane", "0,1800,0,0,-1,0", "--focus",
              "780,1800,300,300", caption="At the ridge.")
    case.draw_histogram("without", "with", dim=3)
    pictures = case.save()
    tools.show({"air, " + name: row["air"] for name, row in rows.items()},
               [surface] + [row["path"] for row in rows.values()] + pictures)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
