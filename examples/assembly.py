"""A real assembly: bolts meshed finely first, then the plates grow from the faces they share.

as1-tu-203.stp (Gmsh's documentation) has 18 volumes: a plate, two brackets, a rod, bolts and nuts.
Fragmented, they share faces. The bolts get a fine fixed size. The plate and the brackets, meshed
later, share the bolts' faces: a mesh size function on those carries their fine mesh into the plates.
"""


import gmsh
import meshgrow

import example_tools as tools
from example_tools import COARSE
from page import cases

BOLT_SIZE = 1.5 * COARSE  # millimetres
GROWTH_RATE = 1.2
SIZE_LIMIT = 15.0
TITLES = {"without": "plates by Gmsh's own sizes", "with": "plates grow from the bolts' faces"}


def build_geometry():
    """Imports and fragments; returns the volumes (plates, bolts)."""
    gmsh.model.occ.importShapes(tools.find_model("as1-tu-203.stp"))
    gmsh.model.occ.synchronize()
    names = {entity: gmsh.model.getEntityName(*entity) for entity in gmsh.model.getEntities(3)}
    gmsh.model.occ.fragment(gmsh.model.getEntities(3), [])
    gmsh.model.occ.synchronize()
    # The volumes do not overlap, so fragments keep their tags.
    bolts = [entity for entity, name in names.items() if name.split("/")[-1].startswith("bolt")]
    plates = [entity for entity, name in names.items()
              if name.split("/")[-1].split(" ")[0] in ("plate", "l-bracket")]
    return plates, bolts


def make_mesh(case, name, with_mesh_function):
    """Meshes the assembly for the case; returns reports, the file and the plates."""
    tools.start("assembly " + name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE_LIMIT)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 12)
    plates, bolts = build_geometry()
    shared = sorted(set(tools.surfaces_of(plates)) & set(tools.surfaces_of(bolts)))
    print("   %d volumes, %d surfaces; %d bolts share %d surfaces with %d plates" %
          (len(gmsh.model.getEntities(3)), len(gmsh.model.getEntities(2)), len(bolts), len(shared),
           len(plates)), flush=True)

    def add_bolt_sizes(field):
        field.add_fixed(sources=tools.surfaces_of(bolts), attach=bolts, size=BOLT_SIZE,
                        growth_rate=GROWTH_RATE, size_limit=SIZE_LIMIT)

    # Without the function, the sizes it would ask for are only measured against, quietly.
    asked = meshgrow.SizeField(progress=tools.progress if with_mesh_function else None)
    add_bolt_sizes(asked)
    asked.add_mesh(sources=shared, attach=plates, growth_rate=GROWTH_RATE, size_limit=SIZE_LIMIT)
    field = asked
    if not with_mesh_function:
        field = meshgrow.SizeField(progress=tools.progress)
        add_bolt_sizes(field)
    tools.generate(field, "the assembly " + name)
    if not with_mesh_function:
        asked.refresh()
    path = tools.write("assembly_%s.msh" % name)
    reports = {"plates, " + name: meshgrow.report(3, plates, asked),
               "all, " + name: meshgrow.report(3)}
    if with_mesh_function:
        print("\n" + asked.summary(), end="")
    case.add(name, TITLES[name], path, reports["plates, " + name], field,
             facts={"elements of all volumes": reports["all, " + name]["elements"]})
    gmsh.model.remove()
    return reports, path, plates


def main():
    gmsh.initialize()
    case = cases.Case(
        "assembly", "bolts", title="Plates around finely meshed bolts",
        about="A real assembly of 18 volumes. The bolts are meshed first; the plate and the "
        "brackets share faces with them. Left to Gmsh, the plates' sizes jump beside the bolts; with a mesh "
        "size function on the shared faces, they grow from them.",
        premeshed="the bolts, with a fixed size of %g mm" % BOLT_SIZE,
        measured="the plate and the brackets")
    rows, paths = {}, []
    for name in ("without", "with"):
        reports, path, plates = make_mesh(case, name, name == "with")
        rows.update(reports)
        paths.append(path)
    case.draw("surface", "without", "with", "--dim", "2", "--view", "-55,0,-30",
              caption="The surfaces of all volumes.")
    case.draw("cut", "without", "with", "--plane", "0,75,0,0,-1,0", "--focus", "33,75,15,33",
              caption="Cut along the axis of a bolt, the red column left of the middle. The scale "
              "of colours is that of the whole assembly.")
    case.draw_histogram("without", "with", 3, [tag for _, tag in plates],
                        caption="The plate and the brackets.")
    tools.show(dict(sorted(rows.items(), key=lambda row: row[0].split(",")[0], reverse=True)),
               paths + case.save())
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
