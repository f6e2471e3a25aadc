"""Figure 1 of the paper: airfoils with small elements at the nose, at the shock and at the tail.

A fixed size function has one size on all of its sources. For three places it takes six of them, on
a vertex and on five parts of the airfoil, whose curves have to be split there. The other way: bunch
the nodes of the airfoil's curves towards these places in the usual way (Transfinite, Bump), mesh
them first, and let one mesh size function grow the sizes that are there into the air.

NACA 0012 is meshed by both ways, and with the bunched curves and Gmsh's own sizes in the air; then
with quadrilaterals; then a cambered airfoil with a flap, whose slot grows from both of its walls.
airfoil.geo and airfoil.cpp mesh NACA 0012 by both ways, with the same names and numbers.
"""

import math

import gmsh
import meshgrow
import numpy as np

import example_tools as tools
from page import cases

GROWTH_RATE = 1.2
SIZE_LIMIT = 1.0
QUADRILATERAL = 3  # Gmsh's number
FRONTAL_DELAUNAY = 6  # Mesh.Algorithm; with quadrilaterals as well, its triangles are recombined
FAR = 4.0  # radius of the air around the airfoil, in chords
SHOCK = 0.6  # where it is on the upper side, in chords from the nose
PANEL = 0.004  # between points of the splines
STEPS = 2000  # along a curve, to measure it
# Of NACA 0012, from the nose over the shock to the tail and back below: number of nodes, and Bump.
BUNCHING = ((32, 0.22), (27, 0.3), (40, 0.15))
# The same sizes by size functions on parts of it: ends of a, b, c … on the upper side, and below.
UPPER, LOWER = (0.0, 0.01, 0.04, 0.578, 0.622, 0.98, 1.0), (1.0, 0.98, 0.04, 0.01, 0.0)
FIXED_SIZES = {"a": 0.007, "bc": 0.009, "de": 0.0075, "fg": 0.007, "hj": 0.007, "kl": 0.009}


class Naca:
    """Points of a four-digit NACA airfoil with a closed tail, its tail turned down by `angle`."""

    def __init__(self, camber, camber_at, thickness, chord=1.0, angle=0.0, nose=(0.0, 0.0)):
        self.camber, self.camber_at, self.thickness = camber, camber_at, thickness
        self.chord, self.angle, self.nose = chord, math.radians(angle), nose

    def place(self, side, x):
        """Where the upper (1) or lower side (-1) is at x of the chord, 0 to 1."""
        half = 5 * self.thickness * (0.2969 * math.sqrt(x) + x * (-0.1260 + x * (
            -0.3516 + x * (0.2843 - x * 0.1036))))
        line, slope = 0.0, 0.0
        if self.camber:
            part = self.camber_at if x < self.camber_at else 1 - self.camber_at
            way = (x - self.camber_at) / part
            line, slope = self.camber * (1 - way * way), -2 * self.camber * way / part
        turn = math.atan(slope)
        along = self.chord * (x - side * half * math.sin(turn))
        above = self.chord * (line + side * half * math.cos(turn))
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        return (self.nose[0] + along * cos + above * sin,
                self.nose[1] - along * sin + above * cos)


NACA_0012 = Naca(0.0, 0.0, 0.12)
# NACA 4412 with a flap: turned down by 25 degrees, the slot 1.5 % of the chord.
MAIN = Naca(0.04, 0.4, 0.12, chord=0.8)
FLAP = Naca(0.02, 0.4, 0.14, chord=0.3, angle=25, nose=(0.785, -0.03))
BUNCHING_MAIN = BUNCHING
BUNCHING_FLAP = ((27, 0.3), (27, 0.3))


def add_side(naca, side, ends):
    """Splines of a side between points {x of the chord: its tag}; returns their tags."""
    return [add_spline(naca, side, start, end, ends[start], ends[end])
            for start, end in zip(list(ends), list(ends)[1:])]


def add_spline(naca, side, start, end, first, last):
    """A spline of a side from x = start to end.

    Its points are equally far apart, as Gmsh bunches by the parameter of a curve.
    """
    begin, finish = math.acos(1 - 2 * start), math.acos(1 - 2 * end)
    xs = [0.5 * (1 - math.cos(begin + i * (finish - begin) / STEPS)) for i in range(STEPS + 1)]
    places = [naca.place(side, x) for x in xs]
    walked = [0.0]
    for (x0, y0), (x1, y1) in zip(places, places[1:]):
        walked.append(walked[-1] + math.sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0)))
    count = math.ceil(walked[-1] / PANEL)
    points = [first]
    for i in range(1, STEPS):
        if walked[i] >= len(points) * walked[-1] / count and len(points) < count:
            points.append(gmsh.model.geo.addPoint(*places[i], 0))
    return gmsh.model.geo.addSpline(points + [last])


def add_point(naca, side, x):
    return gmsh.model.geo.addPoint(*naca.place(side, x), 0)


def add_air(airfoils):
    """A disk with the airfoils cut out; returns its surface."""
    geo = gmsh.model.geo
    center = geo.addPoint(0.5, 0, 0)
    rim = [geo.addPoint(0.5 + FAR * x, FAR * y, 0) for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))]
    arcs = [geo.addCircleArc(rim[i], center, rim[(i + 1) % 4]) for i in range(4)]
    surface = geo.addPlaneSurface([geo.addCurveLoop(arcs)] +
                                  [geo.addCurveLoop(curves) for curves in airfoils])
    geo.synchronize()
    return 2, surface


# The first way: curves that are bunched, and one size function.

def bunched_curves(naca, bunching, upper_split=()):
    """Curves from the nose over the upper side to the tail and back below.

    upper_split: where the upper side is split; bunching: nodes and Bump of each curve
    """
    nose, tail = add_point(naca, 1, 0.0), add_point(naca, 1, 1.0)
    upper = {0.0: nose, **{x: add_point(naca, 1, x) for x in upper_split}, 1.0: tail}
    curves = add_side(naca, 1, upper) + add_side(naca, -1, {1.0: tail, 0.0: nose})
    for curve, (count, bump) in zip(curves, bunching):
        gmsh.model.geo.mesh.setTransfiniteCurve(curve, count, "Bump", bump)
    return curves


def one_mesh_function(curves, air):
    field = meshgrow.SizeField()
    field.add_mesh(sources=[(1, curve) for curve in curves], attach=[air],
                   growth_rate=GROWTH_RATE, size_limit=SIZE_LIMIT)
    return field


# The second way: curves that are split where sizes shall be, and six size functions.

def split_curves(naca):
    """The curves of Figure 1, and {name: entity} of the vertex a and of those with a size.

    a is the nose; b to g are on the upper side, h to l below, back to the nose. The tail is closed,
    so that g and h are one point.
    """
    upper = {x: add_point(naca, 1, x) for x in UPPER}
    lower = {x: add_point(naca, -1, x) for x in LOWER[1:-1]}
    lower = {1.0: upper[1.0], **lower, 0.0: upper[0.0]}
    ab, bc, cd, de, ef, fg = add_side(naca, 1, upper)
    hj, jk, kl, la = add_side(naca, -1, lower)
    named = {"a": (0, upper[0.0]), "bc": (1, bc), "de": (1, de), "fg": (1, fg), "hj": (1, hj),
             "kl": (1, kl)}
    return [ab, bc, cd, de, ef, fg, hj, jk, kl, la], named


def six_fixed_functions(named, air):
    field = meshgrow.SizeField()
    for name, size in FIXED_SIZES.items():
        field.add_fixed(sources=[named[name]], attach=[air], size=size,
                        growth_rate=GROWTH_RATE, size_limit=SIZE_LIMIT, name=name)
    return field


# Airfoils: each is built, and returns its curves, the air around it and its size functions.

def build_bunched():
    curves = bunched_curves(NACA_0012, BUNCHING, [SHOCK])
    air = add_air([curves])
    return curves, air, one_mesh_function(curves, air)


def build_split():
    curves, named = split_curves(NACA_0012)
    air = add_air([curves])
    return curves, air, six_fixed_functions(named, air)


def build_with_flap():
    main, flap = bunched_curves(MAIN, BUNCHING, [SHOCK]), bunched_curves(FLAP, BUNCHING_FLAP)
    air = add_air([main, flap])
    return main + flap, air, one_mesh_function(main + flap, air)


# What is measured along an airfoil.

def edges_along(curves):
    """Middle and length of the edges of the curves, and the lengths of the edges at each node."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    place = dict(zip(map(int, tags), np.reshape(coordinates, (-1, 3))))
    middles, lengths, at_node = [], [], {}
    for curve in curves:
        for edge in np.reshape(gmsh.model.mesh.getElements(1, curve)[2][0], (-1, 2)).tolist():
            ends = [place[node] for node in edge]
            middles.append(np.mean(ends, axis=0))
            lengths.append(np.linalg.norm(ends[1] - ends[0]))
            for node in edge:
                at_node.setdefault(node, []).append(lengths[-1])
    return np.array(middles), np.array(lengths), at_node


def measure_along(curves, naca):
    """Length of the edges at nose, shock and tail, and the largest ratio of two that meet."""
    middles, lengths, at_node = edges_along(curves)
    sizes = {}
    for name, x in (("nose", 0.0), ("shock", SHOCK), ("tail", 1.0)):
        away = np.linalg.norm(middles[:, :2] - naca.place(1, x), axis=1)
        sizes[name] = float(lengths[np.argsort(away)[:2]].mean())
    return {**sizes, "edges": len(lengths),
            "along": float(max(max(pair) / min(pair) for pair in at_node.values()))}


def share_of_quads(air):
    kinds, elements, _ = gmsh.model.mesh.getElements(*air)
    counts = {kind: len(tags) for kind, tags in zip(kinds, elements)}
    return counts.get(QUADRILATERAL, 0) / sum(counts.values())


# What is meshed.

# Name of a case: how it is built, of which airfoil it is told what is along it, quadrilaterals.
CASES = {
    "naca0012": (build_bunched, NACA_0012, False),
    "naca0012_quads": (build_bunched, NACA_0012, True),
    "cambered_flap": (build_with_flap, MAIN, False),
}
VARIANTS = {
    "without": "curves bunched, Gmsh's own sizes in the air",
    "fixed": "six fixed size functions",
    "with": "curves bunched, one mesh size function",
}
PAGE = {  # title, about; point, radius and caption of each picture
    "naca0012": (
        "NACA 0012, sizes at nose, shock and tail",
        "One mesh size function on curves that are bunched in the usual way takes the place of six "
        "fixed ones. Left to Gmsh, the small elements beside it end after a few layers.",
        ((0.5, 0, 0.65, "The whole airfoil."), (0.06, 0, 0.12, "Its nose."))),
    "naca0012_quads": (
        "NACA 0012, quadrilaterals",
        "The same with quadrilaterals: without the size function, sizes jump beside the airfoil.",
        ((0.5, 0, 0.65, "The whole airfoil."),)),
    "cambered_flap": (
        "NACA 4412 with a flap",
        "A cambered airfoil with a flap: the slot between them grows from both of its walls.",
        ((0.55, -0.02, 0.7, "Airfoil and flap."), (0.79, -0.02, 0.1, "The slot between them."))),
}


def variants_of(name):
    return [variant for variant in VARIANTS if name == "naca0012" or variant != "fixed"]


def make_mesh(name, variant):
    """Meshes a variant of a case; returns its numbers and what the page needs."""
    build, naca, quads = CASES[name]
    gmsh.model.add(name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE_LIMIT)
    gmsh.option.setNumber("Mesh.Algorithm", FRONTAL_DELAUNAY)
    curves, air, asked = (build_split if variant == "fixed" else build)()
    if quads:
        gmsh.model.mesh.setRecombine(2, air[1])
    print("-- %s: %s" % (name, VARIANTS[variant]), flush=True)
    seconds = None
    if variant == "without":
        seconds = tools.generate_by_gmsh(2)
        asked.refresh()  # the sizes it would ask for are only measured against
    else:
        asked.generate(2)
    report = meshgrow.report(2, [air], asked)
    row = {**report, **measure_along(curves, naca),
           "quads": share_of_quads(air), "input": lines_of_input(name, variant, curves, asked)}
    page = {"mesh": tools.write("airfoil_%s_%s.msh" % (name, variant)), "seconds": seconds,
            "report": report,
            "field": asked if variant != "without" else None,
            "facts": {"lines of input": row["input"], "curves of the airfoil": len(curves),
                      "edges on the airfoil": row["edges"],
                      "size at nose, shock, tail": "%.4f, %.4f, %.4f" % (
                          row["nose"], row["shock"], row["tail"]),
                      "ratio of edges along the airfoil, max": round(row["along"], 2),
                      "quadrilaterals": "%.0f %%" % (100 * row["quads"])}}
    return row, page


def lines_of_input(name, variant, curves, field):
    """Points that split a side, curves that are bunched, size functions: one line each."""
    sides = 4 if name == "cambered_flap" else 2
    bunched = 0 if variant == "fixed" else len(curves)
    functions = 0 if variant == "without" else len(field.functions())
    return len(curves) - sides + bunched + functions


def make_case(name):
    """Meshes a case for the page; returns its rows of the table and its files."""
    title, about, pictures = PAGE[name]
    case = cases.Case("airfoil", name, title=title, figures="Figure 1", about=about,
                      premeshed="curves of the airfoil, bunched by Bump at nose, shock and tail" + (
                          " (nothing for the six fixed size functions)"
                          if name == "naca0012" else ""),
                      measured="the air")
    rows, files = {}, []
    for variant in variants_of(name):
        rows[name, variant], page = make_mesh(name, variant)
        case.add(variant, VARIANTS[variant], **page)
        files.append(page["mesh"])
        gmsh.model.remove()
    for before in variants_of(name)[:-1]:
        for x, y, radius, caption in pictures[:1] if before == "fixed" else pictures:
            case.draw("surface", before, "with", "--dim", "2", "--view", "0,0,0",
                      "--focus", "%g,%g,0,%g" % (x, y, radius),
                      caption="Two ways to about the same sizes." if before == "fixed" else caption)
    case.draw_histogram("without", "with", dim=2)
    return rows, files + case.save()


def show_table(rows):
    """Prints the numbers, a line for each mesh."""
    print("\n%-14s %-8s | input | elements | ratio max   99 %% | length   > 2 %% |  quads |"
          "   nose  shock   tail | along" % ("", ""))
    for (name, variant), row in rows.items():
        print("%-14s %-8s | %5d | %8d | %9.2f %6.2f | %6.2f %5.1f %% | %4.0f %% | %.4f %.4f %.4f | "
              "%5.2f" % (name, variant, row["input"], row["elements"], row["ratio_max"],
                         row["ratio_99"], row["length_median"], 100 * row["length_share_over_2"],
                         100 * row["quads"], row["nose"], row["shock"], row["tail"], row["along"]))
    print("\ninput: points that split curves, bunched curves and size functions; ratio: size of "
          "the larger of\ntwo neighbours over the smaller; length: of edges over the size asked "
          "for, median, and those longer\nthan twice the size; nose, shock, tail: length of the "
          "airfoil's edges there; along: ratio of two of\nits edges that meet, max\n")
    for variant, meaning in VARIANTS.items():
        print("%8s: %s" % (variant, meaning))


def main():
    gmsh.initialize()
    tools.start("airfoil")
    rows, files = {}, []
    for name in CASES:
        more_rows, more_files = make_case(name)
        rows.update(more_rows)
        files += more_files
    show_table(rows)
    tools.show_files(files)
    gmsh.finalize()
    return rows


if __name__ == "__main__":
    main()
