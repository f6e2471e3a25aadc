"""Figures 4, 5, 10 and 11 of the paper: two faces side by side, meshed one after the other.

The left face is mapped (transfinite): opposite sides need the same number of elements. A small size
is asked for on its left edge, or at its upper left corner only. It grows to the right, so that the
common edge would have fewer elements than the left edge: to match, its elements are made smaller
than any size function asked for. Whoever meshes the right face has to know that, or its elements
are too large for the common edge (Figures 4 and 5). A mesh size function on the common edge knows
it, since it reads the mesh that is there (Figures 10 and 11).

The left face is narrow and its sizes stay below a limit of their own, so that matching does not
make its elements too flat: beside the common edge of a face 2 wide they would be 0.1 by 0.4, and a
right face that fits to the edges of 0.1 could not fit to their size as well.
"""

import gmsh
import meshgrow
import numpy as np

import example_tools as tools

GROWTH_RATE = 1.2
LEFT_LIMIT = 0.2
SIZE_LIMIT = 0.5  # of the right face and of Gmsh
HEIGHT = 2.0
RIGHT_WIDTH = 5.0
# Where the sizes come from -> (size there, width of the left face).
SOURCES = {"left edge": (0.1, 0.3), "upper left vertex": (0.04, 0.75)}
RIGHT_FACES = ("triangles", "quads", "mapped")
VARIANTS = {
    "without": "the right face is left to Gmsh",
    "fixed": "the sizes of the left face grow on into the right face (Figures 4 and 5)",
    "with": "a mesh size function on the common edge acts on the right face (Figures 10 and 11)",
}


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


def make_mesh(source, right_face, variant):
    """Meshes both faces; returns the numbers of the table and the file."""
    size, left_width = SOURCES[source]
    gmsh.model.add("two_faces")
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE_LIMIT)
    left, right, common, sources = build_geometry(left_width, right_face)

    field = meshgrow.SizeField()
    field.add_fixed(sources=[sources[source]], attach=[left], size=size,
                    growth_rate=GROWTH_RATE, size_limit=LEFT_LIMIT)
    if variant == "fixed":
        field.add_fixed(sources=[sources[source]], attach=[right], size=size,
                        growth_rate=GROWTH_RATE, size_limit=SIZE_LIMIT)
    if variant == "with":
        field.add_mesh(sources=[common], attach=[right], growth_rate=GROWTH_RATE,
                       size_limit=SIZE_LIMIT)
    field.generate(2)
    across = ratios_across(common, left, right)
    inside = meshgrow.report(2, [right])
    path = tools.write("two_faces_%s_%s_%s.msh" % (source.split()[-1], right_face, variant))
    gmsh.model.remove()
    return {"across_max": across.max(), "across_mean": across.mean(),
            "right_max": inside["ratio_max"], "right_99": inside["ratio_99"],
            "right_elements": inside["elements"]}, path


def show_table(rows):
    """Prints the numbers, a line for each case."""
    print("\nSize ratio of neighbours: the larger element's size (mean edge length) over the "
          "smaller's; 1 is no jump.")
    print("\n%-31s|%s" % ("", "|".join(name.center(25) for name in VARIANTS)))
    print("%-18s %-11s |%s" % ("sizes from", "right face", "|".join(
        ["  across edge | in right  "] * 3)))
    print("%-31s|%s" % ("", "|".join(["   max   mean |  99 %   "] * 3)))
    for source in SOURCES:
        for right_face in RIGHT_FACES:
            numbers = (rows[source, right_face, variant] for variant in VARIANTS)
            print("%-18s %-11s |%s" % (source, right_face, "|".join(
                "  %5.2f %5.2f |  %5.2f   " % (row["across_max"], row["across_mean"],
                                               row["right_99"]) for row in numbers)))
    print()
    for name, meaning in VARIANTS.items():
        print("%8s: %s" % (name, meaning))


def main():
    gmsh.initialize()
    tools.start("two_faces")
    rows, pictures = {}, []
    for source in SOURCES:
        for right_face in RIGHT_FACES:
            print("-- sizes from the %s, right face: %s" % (source, right_face), flush=True)
            paths = {}
            for variant in VARIANTS:
                rows[source, right_face, variant], paths[variant] = make_mesh(
                    source, right_face, variant)
            pictures.append(tools.picture(
                paths["without"], paths["with"],
                "two_faces_%s_%s.png" % (source.split()[-1], right_face),
                ("right face by Gmsh", "grown from the common edge"),
                "--dim", "2", "--view", "0,0,0"))
    show_table(rows)
    tools.show_files(pictures)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
