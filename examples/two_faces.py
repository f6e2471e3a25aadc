"""Figures 4, 5, 10 and 11 of the paper: two faces side by side, meshed one after the other.

The left face is mapped (transfinite): opposite sides need the same number of elements. A small size
is asked for on its left edge, or at its upper left corner only. It grows to the right, so that the
common edge would have fewer elements than the left edge: to match, its elements are made smaller
than any size function asked for. Whoever meshes the right face has to know that, or its elements
are too large for the common edge (Figures 4 and 5). A mesh size function on the common edge knows
it, since it reads the mesh that is there (Figures 10 and 11).

The left face is narrower than in the paper, and its sizes stay below a limit of their own, so that
matching does not make its elements flat: beside the common edge of a face 2 wide they would be 0.1
by 0.4, and a right face that fits to the edges of 0.1 could not fit to their size as well. So the
limit, too, makes the common edge finer than the right face's own function asks for: by the limit it
gets 0.12, by matching 0.1, while from the left edge 0.1 grows to 0.23 on the way there.

two_faces.geo and two_faces.cpp are the same with a mesh size function, one of the six at a time.
"""

import gmsh
import meshgrow
import numpy as np

import example_tools as tools
from page import cases

GROWTH_RATE = 1.2
LEFT_LIMIT = 0.12
SIZE_LIMIT = 0.5  # of the right face and of Gmsh
HEIGHT = 2.0
RIGHT_WIDTH = 4.0
# Where the sizes come from -> (size there, width of the left face).
SOURCES = {"left edge": (0.1, 0.8), "upper left vertex": (0.05, 1.0)}
RIGHT_FACES = ("triangles", "quads", "mapped")
VARIANTS = {
    "without": "the right face is left to Gmsh",
    "fixed": "the sizes of the left face grow on into the right face (Figures 4 and 5)",
    "with": "a mesh size function on the common edge acts on the right face (Figures 10 and 11)",
}
TITLES = {"without": "right face by Gmsh", "fixed": "right face by a fixed function",
          "with": "grown from the common edge"}
FIGURES = {"left edge": "Figures 4 and 10", "upper left vertex": "Figures 5 and 11"}
RIGHT = (2, 2)  # the right face, as built below
# What is drawn beside "with": where elements are mapped, a jump is widest with Gmsh's own sizes.
BEFORE = {"triangles": "fixed", "quads": "fixed", "mapped": "without"}


def build_geometry(left_width, right_face):
    """Two rectangles; returns (left, right, common edge, {name of a source: entity})."""
    geo = gmsh.model.geo
    points = [geo.addPoint(x, y, 0) for x in (0, left_width, left_width + RIGHT_WIDTH)
              for y in (0, HEIGHT)]
    upright = [geo.addLine(points[i], points[i + 1]) for i in (0, 2, 4)]
    below = [geo.addLine(points[i], points[i + 2]) for i in (0, 2)]
    above = [geo.addLine(points[i], points[i + 2]) for i in (1, 3)]
    left, right = (
        geo.addPlaneSurface([geo.addCurveLoop([below[i], upright[i + 1], -above[i], -upright[i]])])
        for i in (0, 1))
    geo.synchronize()
    for face in [left] + [right] * (right_face == "mapped"):
        gmsh.model.mesh.setTransfiniteSurface(face)
    for face in [left] + [right] * (right_face != "triangles"):
        gmsh.model.mesh.setRecombine(2, face)
    sources = {"left edge": (1, upright[0]), "upper left vertex": (0, points[1])}
    return (2, left), (2, right), (1, upright[1]), sources


def sizes_by_edge(face):
    """Mean edge length of the elements of a face, by each of their edges (a pair of nodes)."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    place = dict(zip(map(int, tags), np.reshape(coordinates, (-1, 3))))
    sizes = {}
    for kind, _, nodes in zip(*gmsh.model.mesh.getElements(*face)):
        corners = gmsh.model.mesh.getElementProperties(kind)[3]
        for element in np.reshape(nodes, (-1, corners)).tolist():
            edges = list(zip(element, element[1:] + element[:1]))
            size = np.mean([np.linalg.norm(place[a] - place[b]) for a, b in edges])
            sizes.update((frozenset(edge), size) for edge in edges)
    return sizes


def ratios_across(curve, left, right):
    """Larger over smaller size of the two elements on each edge of the common curve."""
    sizes = sizes_by_edge(left), sizes_by_edge(right)
    edges = np.reshape(gmsh.model.mesh.getElements(*curve)[2][0], (-1, 2)).tolist()
    pairs = np.array([[of_face[frozenset(edge)] for of_face in sizes] for edge in edges])
    return pairs.max(axis=1) / pairs.min(axis=1)


def make_field(variant, left, right, common, source, size):
    """The size functions of a variant."""
    field = meshgrow.SizeField()
    field.add_fixed(sources=[source], attach=[left], size=size,
                    growth_rate=GROWTH_RATE, size_limit=LEFT_LIMIT)
    if variant == "fixed":
        field.add_fixed(sources=[source], attach=[right], size=size,
                        growth_rate=GROWTH_RATE, size_limit=SIZE_LIMIT)
    if variant == "with":
        field.add_mesh(sources=[common], attach=[right], growth_rate=GROWTH_RATE,
                       size_limit=SIZE_LIMIT)
    return field


def make_mesh(source, right_face, variant, case):
    """Meshes both faces and adds them to the case; returns the numbers of the table."""
    size, left_width = SOURCES[source]
    gmsh.model.add("two_faces")
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE_LIMIT)
    left, right, common, sources = build_geometry(left_width, right_face)
    field = make_field(variant, left, right, common, sources[source], size)
    field.generate(2)
    asked = field
    if variant != "with":
        # The sizes that "with" would ask for on this mesh are only measured against.
        asked = make_field("with", left, right, common, sources[source], size)
        asked.refresh()
    across = ratios_across(common, left, right)
    inside = meshgrow.report(2, [right], asked)
    path = tools.write("two_faces_%s_%s_%s.msh" % (source.split()[-1], right_face, variant))
    case.add(variant, TITLES[variant], mesh=path, report=inside, field=field,
             facts={"size ratio across the common edge, max": round(across.max(), 2),
                    "size ratio across the common edge, mean": round(across.mean(), 2)})
    gmsh.model.remove()
    return {"across_max": across.max(), "across_mean": across.mean(),
            "right_max": inside["ratio_max"], "right_99": inside["ratio_99"],
            "right_long": inside["length_share_over_2"], "right_elements": inside["elements"]}


def make_case(source, right_face):
    """Meshes all variants of a case; returns their numbers and the pictures."""
    case = cases.Case(
        "two_faces", "%s_%s" % (source.split()[-1], right_face),
        title="Two faces: sizes from the %s, right face %s" % (
            source, {"triangles": "of triangles", "quads": "of quads"}.get(right_face, right_face)),
        figures=FIGURES[source], measured="the right face",
        about="The mapped left face makes the common edge finer than asked. The right face knows "
              "of it only by the mesh size function; without, its elements jump beside that edge.",
        premeshed="the left face, mapped: its right edge has to have as many elements as its left")
    rows = {variant: make_mesh(source, right_face, variant, case) for variant in VARIANTS}
    before, left_width = BEFORE[right_face], SOURCES[source][1]
    case.draw("surface", before, "with", "--dim", "2", "--view", "0,0,0")
    case.draw("surface", before, "with", "--dim", "2", "--view", "0,0,0",
              "--focus", "%g,%g,0,0.6" % (left_width, HEIGHT / 2),
              caption="At the common edge.")
    case.draw_histogram(before, "with", dim=2, entities=[RIGHT[1]])
    return rows, case.save()


def show_table(rows):
    """Prints the numbers, a line for each case."""
    print("\nSize ratio of neighbours: the larger element's size (mean edge length) over the "
          "smaller's; 1 is no jump.")
    print("\n%-30s|%s" % ("", "|".join(name.center(31) for name in VARIANTS)))
    print("%-18s %-10s |%s" % ("sizes from", "right face", "|".join(
        ["  across edge |   in right     "] * 3)))
    print("%-30s|%s" % ("", "|".join(["   max   mean |  99 %     long  "] * 3)))
    for source in SOURCES:
        for right_face in RIGHT_FACES:
            numbers = (rows[source, right_face, variant] for variant in VARIANTS)
            print("%-18s %-10s |%s" % (source, right_face, "|".join(
                "  %5.2f %5.2f |  %5.2f   %3.0f %%  " % (
                    row["across_max"], row["across_mean"], row["right_99"],
                    100 * row["right_long"]) for row in numbers)))
    print("\nlong: edges longer than twice the size that the mesh size function asks for\n")
    for name, meaning in VARIANTS.items():
        print("%8s: %s" % (name, meaning))


def main():
    gmsh.initialize()
    tools.start("two_faces")
    rows, pictures = {}, []
    for source in SOURCES:
        for right_face in RIGHT_FACES:
            print("-- sizes from the %s, right face: %s" % (source, right_face), flush=True)
            of_variants, drawn = make_case(source, right_face)
            rows.update({(source, right_face, name): row for name, row in of_variants.items()})
            pictures += drawn
    show_table(rows)
    tools.show_files(pictures)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
