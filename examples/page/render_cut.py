#!/usr/bin/env python3
"""Draw one mesh, or two meshes side by side, cut open and coloured by size.

    render_cut.py before.msh after.msh -o picture.png --plane 0,0,0,0,-1,0

The elements are drawn by Gmsh itself: whole tetrahedra, none of them sliced,
each in the colour of its size.  The size of an element is the mean length of
its edges, in the length unit of the mesh.  Both halves of the picture have
the same camera and the same logarithmic colour scale, so that equal colours
and equal lengths mean the same thing on the left and on the right.

Needs: Gmsh with its Python module (4.8 or newer), numpy and Pillow; on a
machine without a display also xvfb-run.
Debian: python3-gmsh python3-numpy python3-pil fonts-dejavu-core xvfb xauth
PyPI:   gmsh numpy pillow
"""

import sys
from pathlib import Path

# The first of them says if numpy is missing.
from environment import import_gmsh, import_pillow, restart_under_xvfb_if_needed
from arguments import (OneSentenceParser, join_negative_values, parse_focus, parse_plane,
                       parse_tags, parse_view, parse_zoom)
from camera import choose_camera
from composition import compose
from errors import RenderError
from mesh_sizes import common_range, measure_file
from panel import DRAWN_PIXELS, draw_panel
from picture_file import save_picture


def build_parser():
    """Return the parser of the command line."""
    parser = OneSentenceParser(
        prog="render_cut",
        description="Draw one or two meshes as a PNG: a cut through whole "
        "elements, coloured by element size (mean edge length).")
    parser.add_argument("meshes", nargs="+", metavar="mesh", type=Path,
                        help="one mesh, or the meshes before and after")
    parser.add_argument("-o", "--output", required=True, type=Path,
                        metavar="picture.png", help="picture to write")
    parser.add_argument("--plane", type=parse_plane, metavar="x,y,z,nx,ny,nz",
                        help="cutting plane through a point; the elements on "
                        "the side the normal points to are taken away, and "
                        "the camera is on that side (default: no cut)")
    parser.add_argument("--dim", type=int, choices=(3, 2), default=3,
                        help="draw the volume elements (3) or the surface "
                        "elements (2); default 3")
    parser.add_argument("--title-before", metavar="TEXT",
                        help="title of the first (or only) mesh")
    parser.add_argument("--title-after", metavar="TEXT",
                        help="title of the second mesh")
    parser.add_argument("--volumes", type=parse_tags, metavar="1,2,...",
                        help="draw these volumes only (with --dim 2: these "
                        "surfaces)")
    parser.add_argument("--view", type=parse_view, default="front",
                        metavar="front|iso|rx,ry,rz",
                        help="look straight at the cut, look at it from the "
                        "side and above, or Gmsh's General.RotationX,Y,Z in "
                        "degrees; default front")
    parser.add_argument("--zoom", type=parse_zoom, default=1.0, metavar="F",
                        help="enlarge by this factor; default 1")
    parser.add_argument("--focus", type=parse_focus, metavar="x,y,z,radius",
                        help="fill the picture with the surroundings of this "
                        "point (lengths in the unit of the mesh)")
    return parser


def parse_arguments(arguments):
    """Return the options, checked as far as possible without the meshes."""
    parser = build_parser()
    options = parser.parse_args(join_negative_values(arguments))
    if len(options.meshes) > 2:
        parser.error("give one or two meshes, not "
                     f"{len(options.meshes)}")
    if options.output.suffix.lower() != ".png":
        parser.error(f"the picture '{options.output}' must be named *.png")
    if not options.output.absolute().parent.is_dir():
        parser.error(f"the folder of '{options.output}' does not exist, "
                     "create it first")
    for mesh in options.meshes:
        if not mesh.is_file():
            parser.error(f"there is no file '{mesh}', check the name")
    return options


def captions_of(meshes, options):
    """Return title and number of elements for each mesh."""
    if len(meshes) == 2:
        titles = [options.title_before or "before",
                  options.title_after or "after"]
    else:
        titles = [options.title_before or options.meshes[0].stem]
    return [(title, f"{len(mesh.sizes):,} {mesh.name}")
            for title, mesh in zip(titles, meshes)]


def render(options):
    """Measure the meshes, draw them and write the picture."""
    gmsh = import_gmsh()
    meshes = [measure_file(gmsh, path, options.dim, options.volumes) for path in options.meshes]
    size_range = common_range(meshes)
    camera = choose_camera(meshes, options)
    captions = captions_of(meshes, options)
    del meshes  # the child processes need the memory
    panels = [draw_panel(path, camera, size_range, options)
              for path in options.meshes]
    picture = compose(panels, captions, size_range)
    save_picture(picture, options.output)
    print(f"{options.output}: {picture.width} x {picture.height} pixels, "
          f"{options.output.stat().st_size / 1000:.0f} kB")


def main(arguments):
    """Run the program; return its exit code."""
    try:
        options = parse_arguments(arguments)
        import_pillow()
        import_gmsh()
        restart_under_xvfb_if_needed(DRAWN_PIXELS)
        render(options)
    except RenderError as error:
        print(f"render_cut: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
