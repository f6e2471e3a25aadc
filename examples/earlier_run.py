"""Refinement from an earlier run: the surface mesh stays, the volume is meshed coarser and finer.

An earlier study has meshed a part and saved its CAD and its mesh; what stands on the surface (loads,
contacts, results to compare with) goes by the nodes there. A later run reads both files back, throws
the tetrahedra away and meshes the volume again between the very same triangles: coarser, by a larger
growth rate, and finer, by a smaller one and a smaller limit. Gmsh alone, asked for the volume, meshes
the surface anew; "without" is a size field without functions, which keeps the surface and leaves the
sizes in the volume to Gmsh.

All runs read the CAD from the same file: the mesh finds its curves and surfaces by their tags.

earlier_run.geo and earlier_run.cpp are the later run alone, with the files that this one writes.
"""

import os

import gmsh
import meshgrow
import numpy as np

import example_tools as tools
from example_tools import COARSE
from page import cases

STUDY = {"angle": 24 * COARSE, "growth_rate": 1.2, "size_limit": 0.5 * COARSE, "min_size": 0.05}
# Growth rate and limit in the volume, of the later runs.
LATER = {"coarser": (1.5, 2.0), "finer": (1.1, 0.3 * COARSE)}
TITLES = {"without": "volume with Gmsh's sizes", "coarser": "coarser: growth 1.5, limit 2",
          "finer": "finer: growth 1.1, limit %g" % LATER["finer"][1]}


def write_part():
    """A block with a spherical pocket and three drilled holes; returns the path of the CAD file."""
    occ = gmsh.model.occ
    block = occ.addBox(-3, -2, -2, 6, 4, 4)
    holes = [(3, occ.addSphere(-1, 0, 2, 1.3))]
    holes += [(3, occ.addCylinder(x, y, -3, 0, 0, 6, radius))
              for x, y, radius in ((1.2, 0, 0.4), (2.2, 1.2, 0.15), (2.2, -1.2, 0.15))]
    occ.cut([(3, block)], holes)
    occ.synchronize()
    path = os.path.join(tools.OUT, "earlier_run.brep")
    gmsh.write(path)
    gmsh.model.remove()
    return path


def open_part(cad):
    """Imports the CAD; all runs do it, so that all have the same tags."""
    gmsh.model.occ.importShapes(cad)
    gmsh.model.occ.synchronize()


def run_study(cad):
    """The earlier run; returns the path of its mesh, and its triangles."""
    gmsh.model.add("earlier run")
    open_part(cad)
    surfaces, volumes = gmsh.model.getEntities(2), gmsh.model.getEntities(3)
    field = meshgrow.SizeField()
    field.add_curvature(sources=surfaces, attach=volumes, **STUDY)
    tools.generate(field, "the part, in the earlier run")
    # With all digits, and where on its surface each node is: Gmsh wants that of CAD.
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.option.setNumber("Mesh.SaveParametric", 1)
    mesh = tools.write("earlier_run_study.msh")
    triangles = surface_triangles()
    gmsh.model.remove()
    return mesh, triangles


def open_study(cad, mesh):
    """Reads the CAD and its mesh back, and throws away the tetrahedra."""
    gmsh.model.add("later run")
    open_part(cad)
    gmsh.merge(mesh)
    gmsh.model.mesh.clear(gmsh.model.getEntities(3))


def surface_triangles():
    """Corners of all triangles, bit by bit, in an order of their own."""
    nodes, coordinates, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(nodes)
    corners = gmsh.model.mesh.getElementsByType(2)[1]
    places = order[np.searchsorted(nodes, corners, sorter=order)]
    triangles = np.reshape(np.reshape(coordinates, (-1, 3))[places], (-1, 9))
    return triangles[np.lexsort(triangles.T)]


def make_later_field(name):
    """The mesh size function of a later run: from the whole surface into the volume."""
    growth_rate, size_limit = LATER[name]
    field = meshgrow.SizeField(progress=tools.progress)
    field.add_mesh(sources=gmsh.model.getEntities(2), attach=gmsh.model.getEntities(3),
                   growth_rate=growth_rate, size_limit=size_limit, name="volume")
    return field


def finish(case, name, field, triangles, seconds=None):
    """Measures and writes the current mesh."""
    asked = field
    if asked is None:
        asked = make_later_field("coarser")
        asked.refresh()
    row = {"volume": meshgrow.report(3, field=asked),
           "path": tools.write("earlier_run_%s.msh" % name),
           "same_surface": np.array_equal(triangles, surface_triangles())}
    case.add(name, TITLES[name], row["path"], row["volume"], field, seconds,
             facts={"surface": "%d triangles, %s" % (len(surface_triangles()), "the same"
                                                     if row["same_surface"] else "others")})
    return row


def main():
    gmsh.initialize()
    tools.start("the part")
    cad = write_part()
    mesh, triangles = run_study(cad)
    case = cases.Case(
        "earlier_run", "part", title="A part meshed again on the surface of an earlier run",
        about="The surface mesh is read back from the file of an earlier run and stays as it is, node "
              "by node; the volume grows from its triangles, at two growth rates.",
        premeshed="the whole surface, by the earlier run: %d triangles" % len(triangles),
        measured="the volume, against the sizes of its own run (Gmsh's sizes: of the coarser one)")

    open_study(cad, mesh)
    alone = meshgrow.SizeField()  # without functions: it keeps the surface, all sizes are Gmsh's
    tools.generate(alone, "the volume, with Gmsh's sizes")
    rows = {"without": finish(case, "without", None, triangles, alone.statistics()["seconds"])}
    gmsh.model.remove()

    for name in LATER:
        open_study(cad, mesh)
        field = make_later_field(name)
        tools.generate(field, "the volume, " + name)
        rows[name] = finish(case, name, field, triangles)
        gmsh.model.remove()

    cut = ("--plane", "0,0,0,0,-1,0")
    case.draw("surface", "coarser", "finer", "--dim", "2", "--view", "iso",
              caption="The same in all runs.")
    case.draw("cut", "without", "coarser", *cut)
    case.draw("cut", "coarser", "finer", *cut, caption="By a larger and by a smaller growth rate.")
    case.draw_histogram("without", "coarser", dim=3)
    case.draw_histogram("coarser", "finer", dim=3, caption="By a larger and by a smaller growth rate.")
    pictures = case.save()
    tools.show({name: row["volume"] for name, row in rows.items()},
               [row["path"] for row in rows.values()] + pictures)
    for name, row in rows.items():
        print("%9s: %s" % (name, "the surface is the same, to the bit" if row["same_surface"]
                           else "the surface is ANOTHER one"))
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
