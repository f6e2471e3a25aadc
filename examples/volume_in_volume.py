"""Figures 2, 3, 8 and 9 of the paper: a volume inside another, with all four kinds of functions.

volume.1 encloses volume.2. Each has a proximity and a curvature size function of its own: sfunc.1
and sfunc.2 are attached to volume.1, sfunc.3 and sfunc.4 to volume.2, with the paper's numbers. The
common faces bound both volumes, so that all four act on them and the smallest size wins: the narrow
gap of volume.1 makes it fine (sfunc.1). Inside volume.2 only its own two act, and they ask for
large elements: sizes jump behind the common faces (Figures 2 and 3). A mesh size function carries
the mesh of the common faces, whoever made it so fine, into volume.2 (Figures 8 and 9).

The paper's workaround is to attach the functions crosswise, those of each volume to the other too.
It knows what was asked for on the common faces, not the mesh that came out.

In either order of the volumes (ORDERS): one volume is meshed with its faces, and then the other,
which finds the common faces meshed and keeps them. As in the paper, all functions are there from
the beginning, and those of both volumes act on the common faces, which bound both. So the common
faces are as fine in either order, and in either order it is volume.2 whose own functions do not
know why. In the paper, volume.1 has to be meshed first for the mesh size function to find a mesh.
Here it need not: faces are meshed before any volume, and read in between, so that volume.2 may be
meshed first as well. (What no function can do is to undo a coarse mesh: were the functions of
volume.1 not there before volume.2 and the common faces are meshed, its gap would have to fit to
triangles that are larger than it asks for.)

"similar": a cube with rounded edges inside a larger one, the same gap all around, so that sizes on
the common faces are nearly constant. "not similar": an ellipsoid in a box, its tip close to one
wall; gap, curvature and sizes vary along the common face. volume_in_volume.geo is "new"
(at once).
"""

import itertools
import time

import gmsh
import meshgrow
import numpy as np

import example_tools as tools
from example_tools import COARSE
from page import cases

CELLS_PER_GAP = 3 / COARSE
ANGLE = 25 * COARSE
GROWTH = {"growth_rate": 1.2, "size_limit": 2.0 * COARSE}

VARIANTS = {
    "old": "sfunc.1 to sfunc.4, each volume has its own (Figures 2 and 3)",
    "crosswise": "sfunc.1 to sfunc.4, all attached to both volumes (the paper's workaround)",
    "new": "as old, and a mesh size function from the common faces into volume.2 "
           "(Figures 8 and 9)",
}


TITLES = {"old": "old: proximity and curvature", "crosswise": "crosswise",
          "new": "new: and a mesh size function"}
ORDERS = ("volume.1 first", "volume.2 first")


def build_similar():
    """Two rounded cubes, a gap of 1 between them; returns (volume.1, volume.2, common faces)."""
    inside, outside = tools.rounded_box(8, 2), tools.rounded_box(10, 3)
    _, (pieces, (inner,)) = gmsh.model.occ.fragment([outside], [inside])
    gmsh.model.occ.synchronize()
    outer, = set(pieces) - {inner}
    return outer, inner, tools.surfaces_of([inner])


def build_not_similar():
    """An ellipsoid in a box; its tip is at x = 8, the wall at 8.6; returns the same."""
    occ = gmsh.model.occ
    shape = (3, occ.addSphere(0, 0, 0, 5))
    occ.dilate([shape], 0, 0, 0, 1.6, 1, 1)
    inner, outer, common = tools.enclose(shape, (-11, -6.5, -6.5), (8.6, 6.5, 6.5))
    return outer, inner, common


MODELS = {"similar": build_similar, "not similar": build_not_similar}
FIGURES = {"similar": "Figures 2 and 8", "not similar": "Figures 3 and 9"}


def make_field(variant, outer, inner, common, **options):
    """The size functions of a variant."""
    field = meshgrow.SizeField(**options)
    for volume in (outer, inner):
        attach = [outer, inner] if variant == "crosswise" else [volume]
        field.add_proximity([volume], attach, cells_per_gap=CELLS_PER_GAP, **GROWTH)
        field.add_curvature(tools.surfaces_of([volume]), attach, angle=ANGLE, **GROWTH)
    if variant == "new":
        field.add_mesh(sources=common, attach=[inner], **GROWTH)
    return field


def mean_edges(corners):
    """Mean edge lengths of triangles or tetrahedra with corners (n, 3 or 4, 3)."""
    pairs = itertools.combinations(range(corners.shape[1]), 2)
    return np.mean([np.linalg.norm(corners[:, a] - corners[:, b], axis=1) for a, b in pairs],
                   axis=0)


def jump_behind(faces, volume):
    """Mean size ratio of the tetrahedra on the faces to their triangles there."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tags)

    def corners(nodes):
        places = order[np.searchsorted(tags, nodes, sorter=order)]
        return np.reshape(coordinates, (-1, 3))[places]

    triangles = np.concatenate([np.reshape(gmsh.model.mesh.getElementsByType(2, tag)[1], (-1, 3))
                                for _, tag in faces])
    size_of = dict(zip(map(frozenset, triangles.tolist()), mean_edges(corners(triangles))))
    tetrahedra = np.reshape(gmsh.model.mesh.getElementsByType(4, volume[1])[1], (-1, 4))
    ratios = [size / size_of[frozenset(face)]
              for nodes, size in zip(tetrahedra.tolist(), mean_edges(corners(tetrahedra)))
              for face in itertools.combinations(nodes, 3) if frozenset(face) in size_of]
    return float(np.mean(ratios))


def mesh_only(volume, other, field):
    """Meshes a volume and its faces; the other one stays, or is again, without a mesh."""
    field.generate(3)
    own = set(tools.surfaces_of([other])) - set(tools.surfaces_of([volume]))
    curves = set(tools.boundary(own)) - set(tools.boundary(tools.surfaces_of([volume])))
    gmsh.model.mesh.clear([other])
    if own:
        gmsh.model.mesh.clear(sorted(own))
        gmsh.model.mesh.clear(sorted(curves))


def make_mesh(model, variant, case, order=None):
    """Meshes one variant, at once or in an order, and adds it to the case; returns its numbers."""
    gmsh.model.add("volume_in_volume")
    outer, inner, common = MODELS[model]()
    field = make_field(variant, outer, inner, common, evaluator="grid")  # as in the paper
    if order is not None:
        first, later = (outer, inner) if order == "volume.1 first" else (inner, outer)
        mesh_only(first, later, field)
        field = make_field(variant, outer, inner, common, evaluator="grid")
    begin = time.perf_counter()
    field.generate(3)  # what has a mesh keeps it
    seconds = time.perf_counter() - begin
    print("   %.1f s" % seconds, flush=True)
    asked = field
    if variant != "new":
        # The sizes that "new" would ask for on this mesh are only measured against.
        asked = make_field("new", outer, inner, common, evaluator="exact")
        asked.refresh()
    grids = [group["grid"] for group in field.statistics()["groups"] if group["grid"]]
    grid_bytes = sum(grid["bytes"] for grid in grids)
    row = {"volume.1": meshgrow.report(3, [outer], asked),
           "volume.2": meshgrow.report(3, [inner], asked),
           "jump": jump_behind(common, inner), "jump outside": jump_behind(common, outer),
           "seconds": seconds, "grid_bytes": grid_bytes,
           "grid_seconds": sum(grid["seconds"] for grid in grids)}
    name = variant if order is None else "%s, %s" % (variant, order)
    path = tools.write("volume_in_volume_%s_%s.msh" % (
        model.replace(" ", "_"), name.replace(", ", "_").replace(" ", "_")))
    case.add(name, TITLES[variant] if order is None else name, mesh=path, report=row["volume.2"],
             field=field, facts={"jump at the common faces": round(row["jump"], 2),
                                 "grids, kB": round(grid_bytes / 1e3)})
    row["common"], row["inner"] = [tag for _, tag in common], inner[1]
    gmsh.model.remove()
    return row


def make_case(model):
    """Meshes all variants of a model; returns their numbers and the pictures."""
    case = cases.Case(
        "volume_in_volume", model.replace(" ", "_"),
        title="A volume in a volume, %s" % model, figures=FIGURES[model],
        measured="volume.2, the inner volume",
        about="The narrow gap of the outer volume makes the common faces fine. The functions of "
              "the inner volume do not know it, and its sizes jump behind these faces, whichever "
              "volume is meshed first; a mesh size function grows from the faces as they are.",
        premeshed="the common faces, by the size functions of both volumes")
    rows = {}
    for variant in VARIANTS:
        for order in (None, *ORDERS) if variant != "crosswise" else (None,):
            print("-- %s volumes: %s, %s" % (model, variant, order or "at once"), flush=True)
            rows[(model, variant, order) if order else (model, variant)] = make_mesh(
                model, variant, case, order)
    row = rows[model, "new"]
    case.draw("cut", "old", "new", "--plane", "0,0,0,0,-1,0")
    case.draw("cut", "old, volume.2 first", "new, volume.2 first", "--plane", "0,0,0,0,-1,0",
              caption="Meshed one after the other, volume.2 first.")
    case.draw("surface", "old", "new", "--dim", "2", "--view", "iso",
              "--volumes", ",".join(map(str, row["common"])))
    case.draw_histogram("old", "new", dim=3, entities=[row["inner"]])
    return rows, case.save()


def show_orders(rows):
    """Prints the numbers of both orders."""
    print("\nVolume by volume, in either order; the jump is that at the common faces")
    print("%11s %4s %15s | volume.2  jump  ratio 99 %%  long | volume.1  jump  ratio 99 %%" % (
        "", "", ""))
    for model, variant, order in (key for key in rows if len(key) == 3):
        row = rows[model, variant, order]
        inside, outside = row["volume.2"], row["volume.1"]
        print("%11s %4s %15s | %8d %5.2f %11.2f %3.0f %% | %8d %5.2f %11.2f" % (
            model, variant, order, inside["elements"], row["jump"], inside["ratio_99"],
            100 * inside["length_share_over_2"], outside["elements"], row["jump outside"],
            outside["ratio_99"]))


def show_table(rows):
    """Prints the numbers, a block for each model."""
    for model in MODELS:
        print("\n%s volumes" % model.capitalize())
        print("%9s |%s|%s|    grids    | meshing" % (
            "", "volume.2, inside".center(43), "volume.1, outside".center(36)))
        print("%9s |  elements   jump  ratio 99 %%    max  long |  elements  ratio 99 %%    max  "
              "long |    kB     s |       s" % "")
        for variant in VARIANTS:
            row = rows[model, variant]
            inside, outside = ("%11.2f %6.2f %4.0f %%" % (
                row[name]["ratio_99"], row[name]["ratio_max"],
                100 * row[name]["length_share_over_2"]) for name in ("volume.2", "volume.1"))
            print("%9s |  %8d %6.2f %s|  %8d %s| %5.0f %5.2f | %7.1f" % (
                variant, row["volume.2"]["elements"], row["jump"], inside,
                row["volume.1"]["elements"], outside, row["grid_bytes"] / 1e3,
                row["grid_seconds"], row["seconds"]))
    print("\njump: size of the tetrahedra on the common faces over the size of their triangles "
          "there, mean; ratio: size\nof the larger of two neighbours over the smaller; long: edges "
          "longer than twice the size that new asks for;\ngrids: memory of the background grids "
          "and time to build them; meshing: with the grids\n")
    for variant, meaning in VARIANTS.items():
        print("%9s: %s" % (variant, meaning))


def main():
    gmsh.initialize()
    tools.start("volume_in_volume")
    rows, pictures = {}, []
    for model in MODELS:
        of_model, drawn = make_case(model)
        rows.update(of_model)
        pictures += drawn
    show_table(rows)
    show_orders(rows)
    tools.show_files(pictures)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
