"""Figure 8 of the paper: a volume inside another, both grow from their common faces.

The common faces are meshed first, finely at one corner and coarsely at the opposite one (in the
paper, the outer volume's size functions do that). Without a size function that knows this mesh, the
sizes jump beside the faces; a mesh size function on them carries their sizes into both volumes.
"""

import math

import gmsh
import meshgrow

import example_tools as tools
from example_tools import COARSE
from page import cases

GROWTH_RATE = 1.2
TITLES = {"no extension": "Gmsh's own sizes",
          "without": "Gmsh extends the sizes of the faces",
          "with": "a mesh size function on the common faces"}
SIZE_LIMIT = 2.0


def build_geometry():
    """A rounded box in a box of side 8; returns (inner, outer, common faces)."""
    return tools.enclose(tools.rounded_box(3, 0.6), (-4, -4, -4), (4, 4, 4))


def premesh(faces):
    """Meshes the faces alone, from 0.08 at one corner to 0.45 at the opposite one."""
    def size(dim, tag, x, y, z, *proposed):
        way = (x + y + z + 3 * 1.5) / (6 * 1.5)
        return COARSE * 0.08 * math.pow(0.45 / 0.08, min(max(way, 0.0), 1.0))

    gmsh.model.mesh.setSizeCallback(size)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)  # the same in each variant
    gmsh.option.setNumber("Mesh.MeshOnlyVisible", 1)
    gmsh.model.setVisibility(gmsh.model.getEntities(), 0)
    gmsh.model.setVisibility(faces + tools.boundary(faces), 1)
    gmsh.model.mesh.generate(2)
    gmsh.model.setVisibility(gmsh.model.getEntities(), 1)
    gmsh.option.setNumber("Mesh.MeshOnlyVisible", 0)
    gmsh.model.mesh.removeSizeCallback()


def make_mesh(case, name, with_size_function, extend_from_boundary=1):
    """Meshes the model for the case; returns reports, the file and the volume and faces to show."""
    tools.start("figure8 " + name)
    inner, outer, common = build_geometry()
    premesh(common)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", extend_from_boundary)

    # Without the function, the sizes it would ask for are only measured against, quietly.
    asked = meshgrow.SizeField(progress=tools.progress if with_size_function else None)
    asked.add_mesh(sources=common, attach=[inner, outer], growth_rate=GROWTH_RATE,
                   size_limit=SIZE_LIMIT)
    # A field without any function meshes in the same order and leaves all sizes to Gmsh.
    field = asked if with_size_function else meshgrow.SizeField(progress=tools.progress)
    tools.generate(field, name)
    path = tools.write("figure8_%s.msh" % name.replace(" ", "_"))
    reports = {
        "outer, " + name: meshgrow.report(3, [outer], asked),
        "inner, " + name: meshgrow.report(3, [inner], asked),
        "faces, " + name: meshgrow.report(2, common),
    }
    if with_size_function:
        print("\n" + asked.summary(), end="")
    case.add(name, TITLES[name], path, reports["outer, " + name], field,
             facts={"inner volume, 99 %": reports["inner, " + name]["ratio_99"]})
    gmsh.model.remove()
    return reports, path, (outer, common)


def main():
    gmsh.initialize()
    case = cases.Case(
        "figure8", "box_in_box", title="A volume inside another", figures="Figure 8",
        about="Both volumes are meshed from the faces that they share. In the outer volume, Gmsh's "
        "sizes leave this mesh behind within a few elements; with a mesh size function on the faces, "
        "their sizes grow into both volumes at the rate asked for.",
        premeshed="the common faces, finely at one corner (0.08) and coarsely at the opposite one "
        "(0.45)", measured="the outer volume")
    rows, paths = {}, []
    for name, extend_from_boundary in (("no extension", 0), ("without", 1), ("with", 1)):
        reports, path, (outer, common) = make_mesh(case, name, name == "with", extend_from_boundary)
        rows.update(reports)
        paths.append(path)
    case.draw("surface", "without", "with", "--dim", "2", "--view", "iso", "--volumes",
              ",".join(str(tag) for _, tag in common),
              caption="The common faces: their mesh was there first and is the same in both.")
    case.draw("cut", "without", "with", "--plane", "0,0,0,0,0,1",
              caption="Cut across the middle. Left, the outer volume is coarse a few layers beside "
              "the common faces; right, its sizes grow from layer to layer.")
    case.draw_histogram("without", "with", 3, [outer[1]], caption="The outer volume.")
    tools.show(dict(sorted(rows.items(), key=lambda row: row[0].split(",")[0], reverse=True)),
               paths + case.save())
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
