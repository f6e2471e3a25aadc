#!/usr/bin/env python3
"""Draw how many elements of two meshes have which size, both in one diagram.

    draw_histogram.py before.msh after.msh -o picture.png --dim 3

The size of an element is the mean length of its edges, in the length unit of
the mesh.  The bins are the same for both meshes and equally wide on the
logarithmic axis, so that one growth rate is one length on it everywhere.

Needs: Gmsh with its Python module (4.8 or newer), numpy and matplotlib.
PyPI:  gmsh numpy matplotlib
"""

import sys
from pathlib import Path

# The first of them says if numpy is missing.
from environment import import_gmsh, import_matplotlib
from arguments import OneSentenceParser, parse_tags
from errors import RenderError
from mesh_sizes import common_range, measure_file
from picture_file import written_beside
from size_scale import format_size, round_sizes

import numpy as np

BINS = 48
WIDTH, HEIGHT, DOTS_PER_INCH = 13, 5.2, 120  # inches
# Neither red nor blue, which mean small and large in the pictures beside.
COLORS = ("#c2620a", "#11665f")
LINE_STYLES = ((0, (5, 1.5)), "solid")


def bin_edges(low, high):
    """Return the edges of the bins, equally spaced on a logarithmic scale."""
    edges = np.geomspace(low, high, BINS + 1)
    edges[0], edges[-1] = low, high  # rounding must not push out the extremes
    return edges


def spaced_ticks(low, high, most=9):
    """Return round sizes to be written at the axis, none of them close to another."""
    space = np.log(high / low) / most
    chosen = []
    for value in round_sizes(low, high):
        if all(abs(np.log(value / other)) > space for other in chosen):
            chosen.append(value)
    return sorted(chosen)


def draw(meshes, titles):
    """Return the figure."""
    figure_class, ticker = import_matplotlib()
    low, high = common_range(meshes)
    edges = bin_edges(low, high)
    figure = figure_class(figsize=(WIDTH, HEIGHT), dpi=DOTS_PER_INCH, layout="constrained")
    figure.get_layout_engine().set(w_pad=0.14, h_pad=0.1)  # inches
    axes = figure.add_subplot()
    for mesh, title, color, style in zip(meshes, titles, COLORS, LINE_STYLES):
        share = 100 * np.histogram(mesh.sizes, edges)[0] / len(mesh.sizes)
        label = "%s: %s %s" % (title, format(len(mesh.sizes), ","), mesh.name)
        axes.stairs(share, edges, fill=True, color=color, alpha=0.16)
        axes.stairs(share, edges, color=color, linewidth=2.2, linestyle=style,
                    label=label.replace("$", r"\$"))
    axes.set_xscale("log")
    axes.set_xlim(low / (high / low) ** 0.015, high * (high / low) ** 0.015)
    axes.set_ylim(bottom=0)
    axes.xaxis.set_major_locator(ticker.FixedLocator(spaced_ticks(low, high)))
    axes.xaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: format_size(value)))
    axes.xaxis.set_minor_locator(ticker.NullLocator())
    axes.set_xlabel("element size = mean edge length (unit of the mesh, log scale)", fontsize=14)
    axes.set_ylabel("share of the elements (%)", fontsize=14)
    axes.tick_params(labelsize=13)
    axes.grid(axis="y", color="#dddddd")
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.legend(loc="outside upper left", fontsize=14, frameon=False)
    return figure


def parse_arguments(arguments):
    """Return the options, checked as far as possible without the meshes."""
    parser = OneSentenceParser(
        prog="draw_histogram",
        description="Draw the element sizes (mean edge length) of two meshes as a histogram.")
    parser.add_argument("meshes", nargs=2, metavar=("before.msh", "after.msh"), type=Path)
    parser.add_argument("-o", "--output", required=True, type=Path, metavar="picture.png")
    parser.add_argument("--title-before", default="before", metavar="TEXT")
    parser.add_argument("--title-after", default="after", metavar="TEXT")
    parser.add_argument("--dim", type=int, choices=(2, 3), default=3,
                        help="count surface elements (2) or volume elements (3); default 3")
    parser.add_argument("--entities", type=parse_tags, metavar="1,2,...",
                        help="count elements of these surfaces or volumes only")
    options = parser.parse_args(arguments)
    for mesh in options.meshes:
        if not mesh.is_file():
            parser.error(f"there is no file '{mesh}', check the name")
    return options


def main(arguments):
    """Run the program; return its exit code."""
    options = parse_arguments(arguments)
    try:
        gmsh = import_gmsh()
        meshes = [measure_file(gmsh, path, options.dim, options.entities)
                  for path in options.meshes]
        figure = draw(meshes, (options.title_before, options.title_after))
        with written_beside(options.output) as part:
            figure.savefig(part, format="png")
    except RenderError as error:
        print(f"draw_histogram: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
