"""Figures 2, 3, 8 and 9 of the paper: a volume inside another, with all four kinds of functions.

volume.1 encloses volume.2. Each has a proximity and a curvature size function of its own: sfunc.1
and sfunc.2 are attached to volume.1, sfunc.3 and sfunc.4 to volume.2, with the paper's numbers. The
common faces bound both volumes, so that all four act on them and the smallest size wins: the narrow
gap of volume.1 makes it fine (sfunc.1). Inside volume.2 only its own two act, and they ask for
large elements: sizes jump behind the common faces (Figures 2 and 3). A mesh size function carries
the mesh of the common faces, whoever made it so fine, into volume.2 (Figures 8 and 9).

The paper's workaround is to attach the functions crosswise, those of each volume to the other too.
It knows what was asked for on the common faces, not the mesh that came out.

"similar": a cube with rounded edges inside a larger one, the same gap all around, so that sizes on
the common faces are nearly constant. "not similar": an ellipsoid in a box, its tip close to one
wall; gap, curvature and sizes vary along the common face.
"""

import itertools
import time

import gmsh
import meshgrow
import numpy as np

import example_tools as tools

COARSE = float(tools.os.environ.get("MESHGROW_EXAMPLES_COARSE", "1"))  # tests run it coarser
CELLS_PER_GAP = 3 / COARSE
ANGLE = 25 * COARSE
GROWTH = {"growth_rate": 1.2, "size_limit": 2.0 * COARSE}

VARIANTS = {
    "old": "sfunc.1 to sfunc.4, each volume has its own (Figures 2 and 3)",
    "crosswise": "sfunc.1 to sfunc.4, all attached to both volumes (the paper's workaround)",
    "new": "as old, and a mesh size function from the common faces into volume.2 "
           "(Figures 8 and 9)",
}


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
    shape = (3, occ.addSphere(0, 0, 0, 1))
    occ.dilate([shape], 0, 0, 0, 8, 5, 5)
    inner, outer, common = tools.enclose(shape, (-11, -6.5, -6.5), (8.6, 6.5, 6.5))
    return outer, inner, common


MODELS = {"similar": build_similar, "not similar": build_not_similar}


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


def make_mesh(model, variant):
    """Meshes one variant; returns the numbers of the table and the file."""
    gmsh.model.add("volume_in_volume")
    outer, inner, common = MODELS[model]()
    field = make_field(variant, outer, inner, common, evaluator="grid")  # as in the paper
    begin = time.perf_counter()
    field.generate(3)
    seconds = time.perf_counter() - begin
    print("   %.1f s" % seconds, flush=True)
    asked = field
    if variant != "new":
        # The sizes that "new" would ask for on this mesh are only measured against.
        asked = make_field("new", outer, inner, common, evaluator="exact")
        asked.refresh()
    grids = [group["grid"] for group in field.statistics()["groups"] if group["grid"]]
    row = {"volume.1": meshgrow.report(3, [outer], asked),
           "volume.2": meshgrow.report(3, [inner], asked),
           "jump": jump_behind(common, inner), "seconds": seconds,
           "grid_bytes": sum(grid["bytes"] for grid in grids),
           "grid_seconds": sum(grid["seconds"] for grid in grids)}
    path = tools.write("volume_in_volume_%s_%s.msh" % (model.replace(" ", "_"), variant))
    gmsh.model.remove()
    return row, path


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
        paths = {}
        for variant in VARIANTS:
            print("-- %s volumes: %s" % (model, variant), flush=True)
            rows[model, variant], paths[variant] = make_mesh(model, variant)
        pictures.append(tools.picture(
            paths["old"], paths["new"], "volume_in_volume_%s.png" % model.replace(" ", "_"),
            ("old: proximity and curvature", "new: and a mesh size function"),
            "--plane", "0,0,0,0,-1,0"))
    show_table(rows)
    tools.show_files(pictures)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
