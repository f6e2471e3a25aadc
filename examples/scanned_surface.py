"""A scanned surface: its triangles are kept, the volume around it grows from them.

t13_data.stl of Gmsh's documentation is a surface of triangles without CAD, too long and thin to
put tetrahedra on. So it is meshed anew once, as in Gmsh's tutorial t13: the triangles are cut into
parametrised patches, with sizes from the curvature of what was scanned. The result is written as an
STL file and read back, as what a scanner's own software hands over: one discrete surface.

From then on the surface is kept, node by node, and a box of air around it is meshed. By itself,
Gmsh gets from its small triangles to the large ones of the box within a few elements; a mesh size
function with the surface as its source grows at a chosen rate.
"""

import math

import gmsh
import meshgrow
import numpy as np

import example_tools as tools
from example_tools import COARSE
from page import cases

SHARP_EDGE = 40  # degrees between triangles of the file
SMALLEST, LARGEST = 1.2 * COARSE, 6 * COARSE  # on the surface
GROWTH_RATE = 1.2
SIZE_LIMIT = 20 * COARSE  # of the air
MARGIN = 50  # of air around the part


def remesh_scan(name):
    """Meshes an STL file anew with sizes from its curvature; returns the path of an STL file."""
    gmsh.model.add("scan")
    gmsh.merge(tools.find_model(name))
    gmsh.model.mesh.classifySurfaces(math.radians(SHARP_EDGE), True, True, math.pi)
    gmsh.model.mesh.createGeometry()
    surfaces = gmsh.model.getEntities(2)
    field = meshgrow.SizeField()
    field.add_curvature(sources=surfaces, attach=surfaces, angle=18, growth_rate=GROWTH_RATE,
                        size_limit=LARGEST, min_size=SMALLEST)
    tools.generate_registered(field, 2)
    path = tools.write("scanned_surface.stl")
    gmsh.model.remove()
    return path


def open_scan(path):
    """Reads an STL file as a discrete surface in a box of air; returns the surface and the air."""
    gmsh.merge(path)
    (_, surface), = gmsh.model.getEntities(2)
    corners = np.reshape(gmsh.model.getBoundingBox(2, surface), (2, 3))
    (x, y, z), (width, depth, height) = corners[0] - MARGIN, np.ptp(corners, axis=0) + 2 * MARGIN
    geo = gmsh.model.geo
    points = [geo.addPoint(*at, z) for at in
              ((x, y), (x + width, y), (x + width, y + depth), (x, y + depth))]
    lines = [geo.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
    bottom = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    raised = geo.extrude([(2, bottom)], 0, 0, height)
    geo.remove([one for one in raised if one[0] == 3])  # the box without the part in it
    box = [bottom] + [tag for dim, tag in raised if dim == 2]
    air = geo.addVolume([geo.addSurfaceLoop(box), geo.addSurfaceLoop([surface])])
    geo.synchronize()
    return surface, air


def make_mesh(case, path, name, title, with_mesh_function):
    """Meshes the air; tells the case, returns what the test needs."""
    tools.start("scanned surface " + name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE_LIMIT)
    surface, air = open_scan(path)
    scanned = tools.mesh_of((2, surface))
    field = meshgrow.SizeField(progress=tools.progress if with_mesh_function else None)
    field.add_mesh(sources=[(2, surface)], attach=[(3, air)], growth_rate=GROWTH_RATE,
                   size_limit=SIZE_LIMIT)
    if with_mesh_function:
        tools.generate(field, "the air " + name)
        seconds = field.statistics()["seconds"]
    else:
        seconds = tools.generate_by_gmsh()  # keeps the surface: it is discrete
        field.refresh()  # measured against only
    row = {"tag": surface, "scanned": scanned, "surface": tools.mesh_of((2, surface)),
           "air": meshgrow.report(3, [(3, air)], field),
           "path": tools.write("scanned_surface_%s.msh" % name)}
    case.add(name, title, row["path"], row["air"], field if with_mesh_function else None, seconds)
    gmsh.model.remove()
    return row


def main():
    gmsh.initialize()
    tools.start("scanned_surface")
    case = cases.Case(
        "scanned_surface", "t13_kept", title="A scanned surface, kept",
        about="The surface is discrete, without CAD, and stays as it is, node by node. By itself, "
              "Gmsh gets from its triangles to those of the box within a few elements. With a mesh "
              "size function, the air grows from them at the rate that was asked for.",
        premeshed="the whole surface: t13_data.stl, meshed anew by its curvature, from %g to %g, "
                  "and read back from an STL file" % (SMALLEST, LARGEST),
        measured="the air")
    path = remesh_scan("t13_data.stl")
    rows = {"without": make_mesh(case, path, "without", "air by Gmsh", False),
            "with": make_mesh(case, path, "with", "air grown from the surface, %g" % GROWTH_RATE,
                              True)}
    case.draw("surface", "without", "with", "--dim", "2", "--volumes",
              str(rows["with"]["tag"]), "--view", "iso")
    case.draw("cut", "without", "with", "--plane", "0,0,-176,0,-1,0", "--focus",
              "0,0,-176,70")
    case.draw_histogram("without", "with", dim=3)
    pictures = case.save()
    tools.show({"air, " + name: row["air"] for name, row in rows.items()},
               [path] + [row["path"] for row in rows.values()] + pictures)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
