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
is registered as Gmsh's size callback. scanned_surface.py keeps what comes out of that, and grows
from it.
"""

import math
import os

import gmsh
import meshgrow
import numpy as np

import example_tools as tools
from example_tools import COARSE
from page import cases

GROWTH_RATE = 1.2
LIMIT = COARSE / 20  # largest size, times the diagonal of the part
SMALLEST = 0.1  # times the largest size
SHARP_EDGE = 40  # degrees between triangles of an STL file

VARIANTS = {
    "kept": "the triangles of the STL file are the surface mesh",
    "Gmsh": "sizes from curvature by Gmsh, 20 elements for a full turn",
    "meshgrow": "create_defaults: curvature 18 degrees, proximity 3 cells per gap, growth 1.2",
}
TITLES = {"kept": "triangles of the file kept, defaults", "Gmsh": "sizes from curvature by Gmsh",
          "meshgrow": "default size functions of meshgrow"}


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
# What the page tells of a part, and the plane that cuts it.
ABOUT = {
    "t20_data.step": (
        "The part of Gmsh's tutorial t20",
        "A nut with thin chamfers. Gmsh's sizes from curvature know of no gaps; the defaults put "
        "three elements in each of them.",
        "0,172.3,0,0,0,1"),
    "as1-tu-203.stp": (
        "An assembly",
        "18 volumes, some as thin as a large element. Gmsh's sizes from curvature jump from the "
        "bolts to the flat faces beside them, one or two elements across a plate; the defaults "
        "grow from the bolts, and put three elements in each gap.",
        "0,75,0,0,-1,0"),
    "t13_data.stl": (
        "A scanned surface, meshed anew",
        "Triangles without CAD, cut into patches and meshed anew. Kept as they are, they are too "
        "long and thin for size functions to help: Gmsh finds no place for nodes of its own.",
        "0,0,-176,0,-1,0")}


def size_range():
    """Sets the smallest and the largest size in Gmsh and returns them."""
    corners = np.reshape(gmsh.model.getBoundingBox(-1, -1), (2, 3))
    largest = LIMIT * np.linalg.norm(corners[1] - corners[0])
    gmsh.option.setNumber("Mesh.MeshSizeMin", SMALLEST * largest)
    gmsh.option.setNumber("Mesh.MeshSizeMax", largest)
    return SMALLEST * largest, largest


def open_part(part, **options):
    """Opens a part in a model of its own; returns its default field."""
    gmsh.model.add(part)
    PARTS[part](part, **options)
    smallest, largest = size_range()
    field = meshgrow.SizeField()
    field.create_defaults(growth_rate=GROWTH_RATE, size_limit=largest, min_size=smallest)
    return field


def mesh_with_field(field):
    """Meshes what is not discrete; returns how long it took Gmsh and meshgrow."""
    field.generate(3)
    return field.statistics()["seconds"]


def mesh_by_gmsh():
    """Gmsh's own sizes; returns the same."""
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 360 / 18)
    seconds = tools.generate_by_gmsh()
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 0)
    return seconds


def finish(case, part, variant, field, seconds):
    """Measures and writes the current mesh and tells the case; returns the numbers of the table."""
    row = {"surface": meshgrow.report(2, field=field), "volume": meshgrow.report(3, field=field),
           "seconds": seconds}
    path = tools.write("real_parts_%s_%s.msh" % (short_name(part), variant))
    case.add(variant, TITLES[variant], path, row["volume"], field if variant != "Gmsh" else None,
             seconds)
    print("   %s: %.1f s in meshgrow, %.1f s in Gmsh" % (
        variant, seconds["meshgrow"], seconds["gmsh"]), flush=True)
    return row


def mesh_step(case, part):
    """Meshes a STEP file; returns {variant: row}."""
    field = open_part(part)
    rows = {"meshgrow": finish(case, part, "meshgrow", field, mesh_with_field(field))}
    gmsh.model.mesh.clear()
    rows["Gmsh"] = finish(case, part, "Gmsh", field, mesh_by_gmsh())
    gmsh.model.remove()
    return rows


def mesh_stl(case, part):
    """Meshes an STL file; returns the same. Patches keep the mesh that they got, so each variant
    begins with the file."""
    rows = {}
    for variant in VARIANTS:
        field = open_part(part, keep_triangles=variant == "kept")
        if variant == "kept":
            seconds = mesh_with_field(field)
        elif variant == "Gmsh":
            field.refresh()  # measured against only: the sizes that the file asks for
            seconds = mesh_by_gmsh()
        else:
            seconds = tools.generate_registered(field)
        rows[variant] = finish(case, part, variant, field, seconds)
        gmsh.model.remove()
    return rows


def short_name(part):
    return os.path.splitext(part)[0]


def mesh_part(part):
    """Meshes a part and draws its case; returns {variant: row} and its pictures."""
    title, about, plane = ABOUT[part]
    case = cases.Case("real_parts", short_name(part), title="%s (%s)" % (title, part), about=about,
                      premeshed="nothing; of the variant that keeps them, the triangles of the file"
                      if PARTS[part] is open_stl else "nothing: sizes come from curvature and gaps",
                      measured="all volumes")
    rows = (mesh_stl if PARTS[part] is open_stl else mesh_step)(case, part)
    case.draw("surface", "Gmsh", "meshgrow", "--dim", "2", "--view", "iso")
    case.draw("cut", "Gmsh", "meshgrow", "--plane", plane)
    case.draw_histogram("Gmsh", "meshgrow", dim=3)
    return rows, case.save()


def show_table(rows):
    """Prints the numbers, a line for each part and variant."""
    print("\n%-15s %-8s | triangles  tetrahedra  ratio 99 %%    max  length/size  long  gamma |"
          " meshgrow    Gmsh" % ("part", "sizes"))
    for (part, variant), row in rows.items():
        volume = row["volume"]
        print("%-15s %-8s | %9d %11d %11.2f %6.2f %12.2f %3.0f %% %6.3f | %6.1f s %5.1f s" % (
            part, variant, row["surface"]["elements"], volume["elements"], volume["ratio_99"],
            volume["ratio_max"], volume["length_median"],
            100 * volume["length_share_over_2"], volume["gamma_min"], row["seconds"]["meshgrow"],
            row["seconds"]["gmsh"]))
    print("\nratio: size of the larger of two neighbours over the smaller, of tetrahedra; "
          "length/size: edge length over\nthe size that meshgrow asks for, median; long: edges "
          "longer than twice that size; gamma: worst quality, 1 is\nbest; meshgrow and Gmsh: the "
          "seconds spent in each\n")
    for variant, meaning in VARIANTS.items():
        print("%9s: %s" % (variant, meaning))


def main():
    gmsh.initialize()
    tools.start("real_parts")
    rows, pictures = {}, []
    for part in PARTS:
        print("-- %s" % part, flush=True)
        made, drawn = mesh_part(part)
        rows.update(((part, variant), made[variant]) for variant in VARIANTS if variant in made)
        pictures += drawn
    show_table(rows)
    tools.show_files(pictures)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
