"""Size callbacks that exist already: three ways to put a size field beside them.

Before: a script with sizes of its own and `gmsh.model.mesh.setSizeCallback(own_sizes)`, smaller towards
the floor of a box. After, a size field keeps the box fine around a sphere as well, and one line of the
script changed, either

    field.combine(own_sizes); field.register()      # no Python code for the field's sizes

or, with the field called where Gmsh calls (each size is a little Python code then),

    gmsh.model.mesh.setSizeCallback(lambda *at: min(own_sizes(*at), field(*at)))

Without sizes of one's own, the field itself is a callback: `gmsh.model.mesh.setSizeCallback(field)`.
"""


import gmsh
import meshgrow

import example_tools as tools
from example_tools import COARSE

GROWTH_RATE = 1.2
SIZE_LIMIT = 0.8
SPHERE_SIZE = 0.1 * COARSE


def own_sizes(dim, tag, x, y, z, lc=1e22):
    """What the user's script had: smaller sizes towards the floor."""
    return min(lc, 0.3 * COARSE + 0.25 * (z + 2.0))


def sphere_in_box():
    """A field of a sphere in a box, and the volume around the sphere."""
    sphere = gmsh.model.occ.addSphere(0, 0, 0, 1)
    _, outer, faces = tools.enclose((3, sphere), (-2, -2, -2), (2, 2, 2))
    field = meshgrow.SizeField()
    field.add_fixed(faces, [outer], SPHERE_SIZE, GROWTH_RATE, SIZE_LIMIT)
    return field, outer


def by_own_sizes(field):
    gmsh.model.mesh.setSizeCallback(own_sizes)


def by_combine(field):
    field.combine(own_sizes)
    field.register()


def by_lambda(field):
    gmsh.model.mesh.setSizeCallback(lambda *at: min(own_sizes(*at), field(*at)))


WAYS = {"own sizes alone": by_own_sizes, "combine, register": by_combine, "lambda": by_lambda}


def main():
    gmsh.initialize(readConfigFiles=False)
    rows, files = {}, []
    for way, set_sizes in WAYS.items():
        tools.start("callbacks, " + way)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE_LIMIT)
        field, outer = sphere_in_box()
        set_sizes(field)
        gmsh.model.mesh.generate(3)
        rows[way] = meshgrow.report(3, [outer], field)
        files.append(tools.write("callbacks_%s.msh" % way.split(",")[0].replace(" ", "_")))
        gmsh.model.mesh.removeSizeCallback()
        field.unregister()
    tools.show(rows, files)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
