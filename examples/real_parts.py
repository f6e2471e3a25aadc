"""Real parts with default size functions: curvature and proximity on everything.

`create_defaults` adds a curvature size function (an element turns by at most 18 degrees) and a
proximity size function (three elements in each gap) of all there is. Beside it, Gmsh with the same
angle (Mesh.MeshSizeFromCurvature = 20 elements for a full turn) and the same smallest and largest
size: it knows of no gaps, and its sizes jump where curved and flat faces meet.

t20_data.step is a nut with thin chamfers, as1-tu-203.stp an assembly of 18 volumes, with plates and
brackets as thin as a large element. Both come with Gmsh's documentation.

t13_data.stl, too, a surface of triangles without CAD. They are discrete: `generate` keeps them, and
curvature and gaps are measured on them. But they were made for the shape only, some 40 times as
long as wide and longer, and Gmsh's Delaunay mesher finds no place for a node of its own between
them, whatever size it is told ("kept" in the table). So the surface is meshed anew, as in Gmsh's
tutorial t13: the triangles are cut into parametrised patches, and the field that was read from them
is registered as Gmsh's size callback.
"""

import math
import os
import time

import gmsh
import meshgrow
import numpy as np

import example_tools as tools

COARSE = float(os.environ.get("MESHGROW_EXAMPLES_COARSE", "1"))  # tests run it coarser
GROWTH_RATE = 1.2
LIMIT = COARSE / 20  # largest size, times the diagonal of the part
SMALLEST = 0.1  # times the largest size
SHARP_EDGE = 40  # degrees between triangles of an STL file

VARIANTS = {
    "kept": "the triangles of the STL file are the surface mesh",
    "Gmsh": "sizes from curvature by Gmsh, 20 elements for a full turn",
    "meshgrow": "create_defaults: curvature 18 degrees, proximity 3 cells per gap, growth 1.2",
}


def open_step(name):
    """Imports a STEP file; its volumes share the faces that they touch at."""
    gmsh.model.occ.importShapes(tools.find_model(name))
    gmsh.model.occ.synchronize()
    volumes = gmsh.model.getEntities(3)
    if len(volumes) > 1:
        gmsh.model.occ.fragment(volumes, [])
        gmsh.model.occ.synchronize()


def open_stl(name, keep_triangles=False):
    """Imports an STL file as a volume in one discrete surface, or in parametrised patches."""
    gmsh.merge(tools.find_model(name))
    if not keep_triangles:
        gmsh.model.mesh.classifySurfaces(math.radians(SHARP_EDGE), True, True, math.pi)
        gmsh.model.mesh.createGeometry()
    loop = gmsh.model.geo.addSurfaceLoop([tag for _, tag in gmsh.model.getEntities(2)])
    gmsh.model.geo.addVolume([loop])
    gmsh.model.geo.synchronize()


PARTS = {"t20_data.step": open_step, "as1-tu-203.stp": open_step, "t13_data.stl": open_stl}
# How render_cut.py shows them.
VIEWS = {"t20_data.step": ("--plane", "0,172.3,0,0,0,1"),
         "as1-tu-203.stp": ("--plane", "0,75,0,0,-1,0"),
         "t13_data.stl": ("--dim", "2", "--view", "iso")}


def size_range():
    """Sets the smallest and the largest size in Gmsh and returns them."""
    corners = np.reshape(gmsh.model.getBoundingBox(-1, -1), (2, 3))
    largest = LIMIT * np.linalg.norm(corners[1] - corners[0])
    gmsh.option.setNumber("Mesh.MeshSizeMin", SMALLEST * largest)
    gmsh.option.setNumber("Mesh.MeshSizeMax", largest)
    return SMALLEST * largest, largest


def open_part(part, **options):
    """Opens a part in a model of its own; returns its default field and a list: when the field said
    what, as pairs."""
    gmsh.model.add(part)
    PARTS[part](part, **options)
    smallest, largest = size_range()
    said = []
    field = meshgrow.SizeField(progress=lambda line: said.append((time.perf_counter(), line)))
    field.create_defaults(growth_rate=GROWTH_RATE, size_limit=largest, min_size=smallest)
    return field, said


def mesh_with_field(field, said):
    """Meshes what is not discrete; returns how long it took, the field and the rest."""
    begin = time.perf_counter()
    field.generate(3)
    end = time.perf_counter()
    read = min(when for when, line in said if line.startswith("Meshing"))
    grids = sum(group["grid"]["seconds"] for group in field.statistics()["groups"] if group["grid"])
    preparing = read - begin + grids
    return preparing, end - begin - preparing


def mesh_with_callback(field):
    """Gmsh meshes discrete patches anew, with the sizes of the field only; returns the same."""
    begin = time.perf_counter()
    field.refresh()
    field.register()
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    ready = time.perf_counter()
    gmsh.model.mesh.generate(3)
    seconds = ready - begin, time.perf_counter() - ready
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
    field.unregister()
    return seconds


def mesh_by_gmsh():
    """Gmsh's own sizes; returns the same."""
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 360 / 18)
    begin = time.perf_counter()
    gmsh.model.mesh.generate(3)
    seconds = 0, time.perf_counter() - begin
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 0)
    return seconds


def finish(part, variant, field, seconds):
    """Measures and writes the current mesh; returns the numbers of the table and the file."""
    row = {"surface": meshgrow.report(2, field=field), "volume": meshgrow.report(3, field=field),
           "seconds": seconds}
    print("   %s: field %.1f s, meshing %.1f s" % (variant, *seconds), flush=True)
    return row, tools.write("real_parts_%s_%s.msh" % (os.path.splitext(part)[0], variant))


def mesh_step(part):
    """Meshes a STEP file; returns {variant: (row, file)}."""
    field, said = open_part(part)
    made = {"meshgrow": finish(part, "meshgrow", field, mesh_with_field(field, said))}
    gmsh.model.mesh.clear()
    made["Gmsh"] = finish(part, "Gmsh", field, mesh_by_gmsh())
    gmsh.model.remove()
    return made


def mesh_stl(part):
    """Meshes an STL file; returns the same. Patches keep the mesh that they got, so each variant
    begins with the file."""
    made = {}
    for variant in VARIANTS:
        field, said = open_part(part, keep_triangles=variant == "kept")
        if variant == "kept":
            seconds = mesh_with_field(field, said)
        elif variant == "Gmsh":
            field.refresh()  # measured against only: the sizes that the file asks for
            seconds = mesh_by_gmsh()
        else:
            seconds = mesh_with_callback(field)
        made[variant] = finish(part, variant, field, seconds)
        gmsh.model.remove()
    return made


def show_table(rows):
    """Prints the numbers, a line for each part and variant."""
    print("\n%-15s %-8s | triangles  tetrahedra  ratio 99 %%    max  length/size  long  gamma |"
          "   field  meshing" % ("part", "sizes"))
    for (part, variant), row in rows.items():
        volume = row["volume"]
        print("%-15s %-8s | %9d %11d %11.2f %6.2f %12.2f %3.0f %% %6.3f | %5.1f s  %5.1f s" % (
            part, variant, row["surface"]["elements"], volume["elements"], volume["ratio_99"],
            volume["ratio_max"], volume["length_median"],
            100 * volume["length_share_over_2"], volume["gamma_min"], *row["seconds"]))
    print("\nratio: size of the larger of two neighbours over the smaller, of tetrahedra; "
          "length/size: edge length over\nthe size that meshgrow asks for, median; long: edges "
          "longer than twice that size; gamma: worst quality, 1 is\nbest; field: sampling, gaps "
          "and grids; meshing: the rest\n")
    for variant, meaning in VARIANTS.items():
        print("%9s: %s" % (variant, meaning))


def main():
    gmsh.initialize()
    tools.start("real_parts")
    rows, pictures = {}, []
    for part in PARTS:
        print("-- %s" % part, flush=True)
        made = mesh_stl(part) if PARTS[part] is open_stl else mesh_step(part)
        rows.update(((part, variant), made[variant][0]) for variant in VARIANTS if variant in made)
        pictures.append(tools.picture(
            made["Gmsh"][1], made["meshgrow"][1], "real_parts_%s.png" % os.path.splitext(part)[0],
            ("sizes from curvature by Gmsh", "default size functions of meshgrow"), *VIEWS[part]))
    show_table(rows)
    tools.show_files(pictures)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
