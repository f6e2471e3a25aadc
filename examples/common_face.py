"""Figures 2, 3, 8 and 9 of the paper: common faces obey both volumes, the volumes only themselves.

A volume lies inside another. Each has size functions of its own. The common faces bound both
volumes: the functions of both act on them, and the smallest size wins. Inside a volume only its own
functions act. Here one volume asks for small sizes and so rules the common faces; the other asks
for large ones, and its elements jump in size right behind them (Figures 2 and 3). A mesh size
function carries the mesh of the common faces into it (Figures 8 and 9). Either volume may rule.

The paper's workaround is to attach the functions crosswise, those of each volume to the other too.
It knows what was asked for on the common faces, not the mesh that came out.

"similar": a cube with rounded edges in a larger box, one size all over the common faces.
"not similar": an ellipsoid with its tip close to one wall of a box, sizes that vary along the
common face. Fixed sizes stand for what the gap (on that wall) or the curvature (at the tip) asks
for.
"""

import time

import gmsh
import meshgrow

import example_tools as tools

GROWTH_RATE = 1.2
SIZE_LIMIT = 1.0
COARSE = float(tools.os.environ.get("MESHGROW_EXAMPLES_COARSE", "1"))  # tests run it coarser
OTHER_SIZE = 0.8  # that the volume which does not rule asks for at the common faces

VARIANTS = {
    "own": "each volume has its own size functions only (Figures 2 and 3)",
    "Gmsh": "the other volume has none; by default Gmsh extends the common faces' sizes into it",
    "crosswise": "the functions of both volumes act on both (the paper's workaround)",
    "meshgrow": "own functions, and a mesh size function carries the common faces' mesh into the "
                "other volume (Figures 8 and 9)",
}


def build_similar():
    """Returns (volumes, common faces, {volume that rules: (sources, size there)})."""
    inner, outer, common = tools.enclose(tools.rounded_box(3, 0.6), (-2.25,) * 3, (2.25,) * 3)
    volumes = {"inner": inner, "outer": outer}
    return volumes, common, {"outer": (common, 0.2), "inner": (common, 0.2)}


def build_not_similar():
    """The same for the ellipsoid; its tip is at z = 2, the wall at 2.3."""
    occ = gmsh.model.occ
    shape = (3, occ.addSphere(0, 0, 0, 1))
    occ.dilate([shape], 0, 0, 0, 1, 1, 2)
    inner, outer, common = tools.enclose(shape, (-1.8, -1.8, -3.2), (1.8, 1.8, 2.3))
    wall = gmsh.model.getEntitiesInBoundingBox(-1.9, -1.9, 2.2, 1.9, 1.9, 2.4, 2)
    tip = gmsh.model.getEntitiesInBoundingBox(-0.1, -0.1, 1.9, 0.1, 0.1, 2.1, 0)
    volumes = {"inner": inner, "outer": outer}
    return volumes, common, {"outer": (wall, 0.08), "inner": (tip, 0.05)}


MODELS = {"similar": build_similar, "not similar": build_not_similar}
OTHER = {"inner": "outer", "outer": "inner"}


def make_field(variant, volumes, common, ruler, source, **options):
    """The size functions of a variant, where the volume `ruler` asks for small sizes."""
    rules, other = [volumes[ruler]], [volumes[OTHER[ruler]]]
    both = rules + other
    entities, size = source
    field = meshgrow.SizeField(**options)
    field.add_fixed(sources=entities, attach=both if variant == "crosswise" else rules,
                    size=COARSE * size, growth_rate=GROWTH_RATE, size_limit=SIZE_LIMIT)
    if variant != "Gmsh":
        field.add_fixed(sources=common, attach=both if variant == "crosswise" else other,
                        size=OTHER_SIZE, growth_rate=GROWTH_RATE, size_limit=SIZE_LIMIT)
    if variant == "meshgrow":
        field.add_mesh(sources=common, attach=other, growth_rate=GROWTH_RATE,
                       size_limit=SIZE_LIMIT)
    return field


def make_mesh(model, ruler, variant):
    """Meshes one variant; returns the numbers of the table and the file."""
    gmsh.model.add("common_face")
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE_LIMIT)
    volumes, common, sources = MODELS[model]()
    field = make_field(variant, volumes, common, ruler, sources[ruler])
    if variant == "meshgrow":
        print(field.plan(3), flush=True)
    begin = time.perf_counter()
    field.generate(3)
    seconds = time.perf_counter() - begin
    asked = field
    if variant != "meshgrow":
        # The sizes that meshgrow would ask for on this mesh are only measured against.
        asked = make_field("meshgrow", volumes, common, ruler, sources[ruler], evaluator="exact")
        asked.refresh()
    grids = [group["grid"] for group in field.statistics()["groups"] if group["grid"]]
    row = {"grid_bytes": sum(grid["bytes"] for grid in grids),
           "grid_seconds": sum(grid["seconds"] for grid in grids), "seconds": seconds}
    for name in volumes:
        row[name] = meshgrow.report(3, [volumes[name]], asked)
    path = tools.write("common_face_%s_%s_%s.msh" % (model.replace(" ", "_"), ruler, variant))
    gmsh.model.remove()
    return row, path


def show_table(rows):
    """Prints the numbers, a block for each model and volume that rules, and what they come to."""
    for model in MODELS:
        for ruler in OTHER:
            print("\n%s volumes, the %s one rules the common faces" % (model, ruler))
            print("%9s |%s|%s|    grids    | meshing" % (
                "", ("%s, the other volume" % OTHER[ruler]).center(36), ruler.center(36)))
            print("%9s |%s|    kB     s |       s" % (
                "", "|".join(["  elements  ratio 99 %    max  long "] * 2)))
            for variant in VARIANTS:
                row = rows[model, ruler, variant]
                volumes = "|".join("  %8d %11.2f %6.2f %4.0f %%" % (
                    row[name]["elements"], row[name]["ratio_99"], row[name]["ratio_max"],
                    100 * row[name]["length_share_over_2"]) for name in (OTHER[ruler], ruler))
                print("%9s |%s| %5.0f %5.2f | %7.1f" % (
                    variant, volumes, row["grid_bytes"] / 1e3, row["grid_seconds"],
                    row["seconds"]))
    print("\nratio: size of the larger of two neighbours over the smaller; long: edges longer than "
          "twice the size\nasked for; grids: memory of the background grids and time to build them; "
          "meshing: with the grids\n")
    for variant, meaning in VARIANTS.items():
        print("%9s: %s" % (variant, meaning))
    print("\nWorst of the four cases, in the other volume and of the grids:")
    print("; ".join("%s %s" % (variant, worst(rows, variant)) for variant in VARIANTS))


def worst(rows, variant):
    """The worst numbers of a variant in a few words."""
    cases = [(row[OTHER[ruler]], row) for (_, ruler, name), row in rows.items() if name == variant]
    return "ratio %.2f, long %.0f %%, %.0f kB" % (
        max(other["ratio_99"] for other, _ in cases),
        100 * max(other["length_share_over_2"] for other, _ in cases),
        max(row["grid_bytes"] for _, row in cases) / 1e3)


def main():
    gmsh.initialize()
    tools.start("common_face")
    rows, pictures = {}, []
    for model in MODELS:
        for ruler in OTHER:
            paths = {}
            for variant in VARIANTS:
                print("-- %s volumes, the %s one rules: %s" % (model, ruler, variant), flush=True)
                rows[model, ruler, variant], paths[variant] = make_mesh(model, ruler, variant)
            pictures.append(tools.picture(
                paths["own"], paths["meshgrow"],
                "common_face_%s_%s.png" % (model.replace(" ", "_"), ruler),
                ("own size functions only", "with a mesh size function"),
                "--plane", "0,0,0,0,-1,0"))
    show_table(rows)
    tools.show_files(pictures)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
