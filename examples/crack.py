"""A crack: an inclined ellipse inside a block, finely meshed first; the volume grows from it.

Stresses are singular at the front of a crack, so its surface is meshed first, with small triangles
at the front and larger ones in its middle. The surface is embedded in the block: tetrahedra have
their faces on it, on both sides. By itself, Gmsh blends the sizes of these triangles with those of
the block's far faces, which are large, so that half a dozen elements lead from the one to the
other. A mesh size function with the crack as its source lets the block grow from the triangles at a
chosen rate.

crack.geo and crack.cpp do the same, step by step. Lengths are in millimetres.
"""

import math

import gmsh
import meshgrow

import example_tools as tools
from example_tools import COARSE
from page import cases

SIDE = 100  # of the block
LENGTH, WIDTH = 50, 30  # of the ellipse
TILT = math.pi / 4  # against the horizontal
FRONT_SIZE = 0.5 * COARSE
CRACK_GROWTH, CRACK_LIMIT = 1.3, 3 * COARSE
BLOCK_GROWTH, BLOCK_LIMIT = 1.2, 12 * COARSE


def build_geometry():
    """The block with the crack in it; returns (block, crack, front)."""
    occ = gmsh.model.occ
    block = occ.addBox(-SIDE / 2, -SIDE / 2, -SIDE / 2, SIDE, SIDE, SIDE)
    crack = occ.addDisk(0, 0, 0, LENGTH / 2, WIDTH / 2)
    occ.rotate([(2, crack)], 0, 0, 0, 1, 0, 0, TILT)
    occ.synchronize()
    gmsh.model.mesh.embed(2, [crack], 3, block)
    (_, front), = gmsh.model.getBoundary([(2, crack)], oriented=False)
    return block, crack, front


def add_crack_sizes(field, crack, front):
    field.add_fixed(sources=[(1, front)], attach=[(2, crack)], size=FRONT_SIZE,
                    growth_rate=CRACK_GROWTH, size_limit=CRACK_LIMIT)


def add_block_sizes(field, block, crack):
    field.add_mesh(sources=[(2, crack)], attach=[(3, block)],
                   growth_rate=BLOCK_GROWTH, size_limit=BLOCK_LIMIT)


def make_mesh(case, name, title, with_mesh_function):
    """Meshes the crack, then the block; tells the case, returns what the test needs."""
    tools.start("crack " + name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", BLOCK_LIMIT)
    block, crack, front = build_geometry()

    # Without the function, the sizes it would ask for are only measured against, quietly.
    asked = meshgrow.SizeField(progress=tools.progress if with_mesh_function else None)
    add_crack_sizes(asked, crack, front)
    add_block_sizes(asked, block, crack)
    field = asked
    if not with_mesh_function:
        field = meshgrow.SizeField(progress=tools.progress)
        add_crack_sizes(field, crack, front)
    tools.generate(field, "the crack and the faces of the block", 2)
    premesh = tools.mesh_of((2, crack))
    first = field.statistics()["seconds"]
    tools.generate(field, "the block " + name)
    if not with_mesh_function:
        asked.refresh()
    row = {"tags": (block, crack), "premesh": premesh, "crack": tools.mesh_of((2, crack)),
           "block": meshgrow.report(3, [(3, block)], asked),
           "path": tools.write("crack_%s.msh" % name)}
    second = field.statistics()["seconds"]
    case.add(name, title, row["path"], row["block"], field,
             seconds={part: first[part] + second[part] for part in first})
    gmsh.model.remove()
    return row


def main():
    gmsh.initialize()
    case = cases.Case(
        "crack", "block", title="A crack in a block",
        about="The crack is embedded in the block. Gmsh blends the small sizes of its front "
              "with the large ones of the block's far faces, which a few elements lead to. "
              "With a mesh size function on the crack, the block grows from its triangles, on both "
              "sides, at the rate that was asked for.",
        premeshed="the crack: %g mm at its front, growing by %g to %g mm in its middle"
                  % (FRONT_SIZE, CRACK_GROWTH, CRACK_LIMIT),
        measured="the block")
    rows = {"without": make_mesh(case, "without", "block by Gmsh", False),
            "with": make_mesh(case, "with", "block grown from the crack, %g" % BLOCK_GROWTH, True)}
    _, crack = rows["with"]["tags"]
    case.draw("surface", "without", "with", "--dim", "2", "--volumes", str(crack),
              "--view", "-45,0,0")
    case.draw("cut", "without", "with", "--plane", "0,0,0,1,0,0")
    case.draw("cut", "without", "with", "--plane", "0,0,0,1,0,0", "--focus", "0,10.6,10.6,9",
              caption="At the front of the crack.")
    case.draw_histogram("without", "with", dim=3)
    pictures = case.save()
    tools.show({"block, " + name: row["block"] for name, row in rows.items()},
               [row["path"] for row in rows.values()] + pictures)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
