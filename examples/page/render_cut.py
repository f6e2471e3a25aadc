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

import argparse
import json
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
except ImportError:
    sys.exit("render_cut: numpy is missing; install the Debian package "
             "python3-numpy or run 'pip install numpy'.")

# Side of one half of the picture, in pixels.
PANEL_PIXELS = 960
# Gmsh draws this many times larger; shrinking smooths the element outlines.
OVERSAMPLING = 2
# Blank border around the mesh, as a fraction of its extent on the screen.
FIT_MARGIN = 0.02
# Longest time Gmsh may take to draw one half, in seconds.
DRAWING_TIMEOUT = 1800
# The picture is stored with as many colours as this number of bytes allows.
MAX_FILE_BYTES = 480_000
PALETTE_SIZES = (256, 192, 128, 96, 64, 48, 32)

# Colours of the sizes from small to large (ColorBrewer "RdYlBu").  All are
# light enough for dark outlines to be seen on them, and red and blue are told
# apart by colour-blind people too.
SIZE_COLORS = ((165, 0, 38), (215, 48, 39), (244, 109, 67), (253, 174, 97),
               (254, 224, 144), (255, 255, 191), (224, 243, 248),
               (171, 217, 233), (116, 173, 209), (69, 117, 180), (49, 74, 160))
COLOR_STEPS = 256
OUTLINE_COLOR = (40, 40, 40)

# The edges of an element, as pairs of its corner nodes in Gmsh's numbering;
# the key is (dimension, number of corners).
ELEMENT_EDGES = {
    (2, 3): ((0, 1), (1, 2), (2, 0)),
    (2, 4): ((0, 1), (1, 2), (2, 3), (3, 0)),
    (3, 4): ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    (3, 5): ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)),
    (3, 6): ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4),
             (2, 5)),
    (3, 8): ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
             (0, 4), (1, 5), (2, 6), (3, 7)),
}
# What to call the elements when all of them have this shape.
ELEMENT_NAMES = {(2, 3): "triangles", (2, 4): "quadrangles",
                 (3, 4): "tetrahedra", (3, 8): "hexahedra"}


class RenderError(Exception):
    """A problem the user can solve; the text is one sentence saying how."""


# --------------------------------------------------------------------------
# Command line
# --------------------------------------------------------------------------

def parse_numbers(text, count, meaning):
    """Return `count` finite numbers from comma-separated text."""
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not all(map(math.isfinite, values)):
        raise argparse.ArgumentTypeError(
            f"expected {count} comma-separated numbers ({meaning}), "
            f"got '{text}'")
    return values


def parse_plane(text):
    """Return [x, y, z, nx, ny, nz] with a unit normal."""
    values = parse_numbers(text, 6, "x,y,z,nx,ny,nz")
    length = math.hypot(*values[3:])
    if length == 0:
        raise argparse.ArgumentTypeError("the normal nx,ny,nz must not be 0")
    return values[:3] + [component / length for component in values[3:]]


def parse_focus(text):
    """Return [x, y, z, radius] with a positive radius."""
    values = parse_numbers(text, 4, "x,y,z,radius")
    if values[3] <= 0:
        raise argparse.ArgumentTypeError("the radius must be positive")
    return values


def parse_view(text):
    """Return 'front', 'iso' or three angles in degrees."""
    if text in ("front", "iso"):
        return text
    return parse_numbers(text, 3, "or the words front or iso")


def parse_zoom(text):
    """Return a positive factor."""
    value, = parse_numbers(text, 1, "the zoom factor")
    if value <= 0:
        raise argparse.ArgumentTypeError("the zoom factor must be positive")
    return value


def parse_tags(text):
    """Return a list of entity tags from comma-separated text."""
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"expected comma-separated volume tags, got '{text}'") from None


def join_negative_values(arguments):
    """Write '--plane -1,0,..' as '--plane=-1,0,..'.

    argparse would take a value that starts with a minus sign for an option.
    """
    joined = []
    for argument in arguments:
        if (joined and joined[-1] in ("--plane", "--focus", "--view")
                and re.match(r"-[\d.]", argument)):
            joined[-1] += "=" + argument
        else:
            joined.append(argument)
    return joined


class OneSentenceParser(argparse.ArgumentParser):
    """An argument parser whose errors are one line, without the usage."""

    def error(self, message):
        """Print the message, say where help is found, and exit with 2."""
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help).\n")


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


# --------------------------------------------------------------------------
# Environment
# --------------------------------------------------------------------------

def import_gmsh():
    """Return the gmsh module or say how to get it."""
    try:
        import gmsh
    except ImportError:
        raise RenderError("the Python module gmsh is missing; install the "
                          "Debian package python3-gmsh or run "
                          "'pip install gmsh'.") from None
    except OSError as error:  # the module is there, its library does not load
        raise RenderError(
            f"Gmsh cannot be loaded ({error}); install the Debian packages "
            "libglu1-mesa, libxft2, libxinerama1, libxcursor1 and "
            "libxfixes3.") from None
    return gmsh


def import_pillow():
    """Return the Pillow modules Image, ImageDraw and ImageFont."""
    try:
        from PIL import Image, ImageDraw, ImageFont
    except ImportError:
        raise RenderError("Pillow is missing; install the Debian package "
                          "python3-pil or run 'pip install pillow'.") from None
    return Image, ImageDraw, ImageFont


def restart_under_xvfb_if_needed(arguments):
    """Without a display, run this program again under xvfb-run.

    Gmsh draws into a window, so it needs an X server even for a file.
    """
    if sys.platform in ("darwin", "win32") or os.environ.get("DISPLAY"):
        return
    for program, package in (("xvfb-run", "xvfb"), ("xauth", "xauth")):
        if not shutil.which(program):
            raise RenderError(
                f"there is no display and {program} is missing; install the "
                f"Debian package {package} or set DISPLAY.")
    # Room for the drawing and for Gmsh's menus around it.
    side = OVERSAMPLING * PANEL_PIXELS
    screen = f"-screen 0 {side + 600}x{side + 300}x24"
    environment = dict(os.environ, FLTK_BACKEND="x11")
    sys.stdout.flush()
    os.execvpe("xvfb-run",
               ["xvfb-run", "-a", "-s", screen, sys.executable,
                os.path.abspath(__file__), *arguments], environment)


# --------------------------------------------------------------------------
# Reading and measuring a mesh
# --------------------------------------------------------------------------

class Mesh:
    """The drawn elements of one mesh.

    tags:     Gmsh's element tags
    sizes:    mean edge length per element, in the unit of the mesh
    corners:  list of arrays (elements, corners, 3) with coordinates
    name:     what to call the elements
    """

    def __init__(self, tags, sizes, corners, name):
        self.tags = tags
        self.sizes = sizes
        self.corners = corners
        self.name = name


def start_gmsh(gmsh):
    """Start Gmsh quietly; neither use nor change the user's settings."""
    gmsh.initialize(readConfigFiles=False)
    for name in ("Terminal", "SaveSession", "SaveOptions"):
        gmsh.option.setNumber("General." + name, 0)


def read_mesh(gmsh, path, dimension, entity_tags):
    """Open a mesh in the running Gmsh and measure its elements."""
    try:
        gmsh.open(str(path))
        types, tags, nodes = collect_elements(gmsh, dimension, entity_tags)
        node_tags, coordinates, _ = gmsh.model.mesh.getNodes()
    except RenderError:
        raise
    except Exception as error:  # gmsh raises plain Exception
        raise RenderError(f"Gmsh cannot read '{path}' ({tidy(error)}); write "
                          "it again as a Gmsh .msh file.") from None
    if not len(types):  # a list or, in newer Gmsh, an array
        other = 5 - dimension
        raise RenderError(
            f"'{path}' has no elements of dimension {dimension}"
            f"{' in these entities' if entity_tags else ''}; mesh it in "
            f"{dimension}D first, or try --dim {other}.")
    order = np.argsort(node_tags)
    sorted_tags = np.asarray(node_tags)[order]
    points = np.asarray(coordinates).reshape(-1, 3)[order]
    sizes, corners, shapes = [], [], set()
    for element_type, node_list in zip(types, nodes):
        _, dim, _, total, _, primary = element_properties(gmsh, element_type)
        edges = ELEMENT_EDGES.get((dim, primary))
        if edges is None:
            raise RenderError(f"'{path}' has elements that are not drawn "
                              f"here (Gmsh type {element_type}); convert the "
                              "mesh to tetrahedra or triangles.")
        # The corner nodes come first, also in elements of higher order.
        first = np.asarray(node_list).reshape(-1, total)[:, :primary]
        xyz = points[np.searchsorted(sorted_tags, first)]
        sizes.append(mean_edge_length(xyz, edges))
        corners.append(xyz)
        shapes.add((dim, primary))
    name = ELEMENT_NAMES.get(shapes.pop()) if len(shapes) == 1 else None
    return Mesh(np.concatenate(tags), np.concatenate(sizes), corners,
                name or "elements")


def collect_elements(gmsh, dimension, entity_tags):
    """Return element types, element tags and node tags, as Gmsh does."""
    if not entity_tags:
        return gmsh.model.mesh.getElements(dimension)
    known = {tag for _, tag in gmsh.model.getEntities(dimension)}
    result = ([], [], [])
    for entity in entity_tags:
        if entity not in known:
            kind = "volume" if dimension == 3 else "surface"
            raise RenderError(
                f"there is no {kind} {entity} in the mesh; leave it out of "
                f"--volumes (there are {abridged(sorted(known))}).")
        for part, found in zip(result, gmsh.model.mesh.getElements(
                dimension, entity)):
            part.extend(found)
    return result


def element_properties(gmsh, element_type):
    """Return name, dimension, order, nodes, coordinates, corner nodes."""
    return gmsh.model.mesh.getElementProperties(element_type)[:6]


def mean_edge_length(xyz, edges):
    """Return the mean edge length of each element, in the mesh's unit."""
    lengths = [np.linalg.norm(xyz[:, a] - xyz[:, b], axis=1)
               for a, b in edges]
    return np.mean(lengths, axis=0)


def measure_file(gmsh, path, options):
    """Read a mesh without drawing it."""
    start_gmsh(gmsh)
    try:
        return read_mesh(gmsh, path, options.dim, options.volumes)
    finally:
        gmsh.finalize()


def common_range(meshes):
    """Return the smallest and largest element size over all meshes."""
    low = float(min(mesh.sizes.min() for mesh in meshes))
    high = float(max(mesh.sizes.max() for mesh in meshes))
    if low <= 0:
        raise RenderError("a mesh has elements of size zero; remove them, as "
                          "a logarithmic scale cannot show them.")
    if high < 1.001 * low:  # a uniform mesh: keep the scale from collapsing
        low, high = low / 1.1, high * 1.1
    return low, high


# --------------------------------------------------------------------------
# Camera
# --------------------------------------------------------------------------

def rotation_from_angles(degrees):
    """Return the matrix of Gmsh's General.RotationX, RotationY, RotationZ."""
    x, y, z = np.radians(degrees)
    about_x = np.array([[1, 0, 0], [0, math.cos(x), -math.sin(x)],
                        [0, math.sin(x), math.cos(x)]])
    about_y = np.array([[math.cos(y), 0, math.sin(y)], [0, 1, 0],
                        [-math.sin(y), 0, math.cos(y)]])
    about_z = np.array([[math.cos(z), -math.sin(z), 0],
                        [math.sin(z), math.cos(z), 0], [0, 0, 1]])
    return about_x @ about_y @ about_z


def angles_from_rotation(matrix):
    """Return General.RotationX, RotationY, RotationZ in degrees."""
    y = math.asin(max(-1.0, min(1.0, matrix[0, 2])))
    if math.cos(y) > 1e-6:
        x = math.atan2(-matrix[1, 2], matrix[2, 2])
        z = math.atan2(-matrix[0, 1], matrix[0, 0])
    else:  # looking along x: only the sum of the two angles matters
        x = math.atan2(matrix[2, 1], matrix[1, 1])
        z = 0.0
    return [math.degrees(angle) for angle in (x, y, z)]


def look_from(direction, up):
    """Return the rotation for a camera in this direction from the mesh.

    The rows are the axes of the screen: to the right, up, to the viewer.
    """
    toward = direction / np.linalg.norm(direction)
    right = np.cross(up, toward)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(toward, right), toward])


def choose_rotation(view, plane):
    """Return the rotation matrix of the camera."""
    if view not in ("front", "iso"):
        return rotation_from_angles(view)
    normal = np.array(plane[3:] if plane else [0.0, -1.0, 0.0])
    z_axis = np.array([0.0, 0.0, 1.0])
    # z is up on the screen, unless the camera looks along z.
    horizontal = abs(normal[2]) > 0.99
    front = look_from(normal, np.array([0.0, 1.0, 0.0]) if horizontal
                      else z_axis)
    if view == "front":
        return front
    right, up = front[0], front[1]
    # From above seen across the cut; a horizontal cut is seen from its near
    # edge, so that z points up on the screen.
    lift = -0.8 * up if horizontal else 0.4 * up
    return look_from(normal + 0.5 * right + lift, z_axis)


def kept_points(mesh, plane):
    """Return the corners of the elements that the cut leaves, (n, 3).

    Gmsh takes an element away if all its corners are beyond the plane.
    """
    kept = []
    for xyz in mesh.corners:
        if plane:
            distance = (xyz - plane[:3]) @ np.array(plane[3:])
            xyz = xyz[distance.min(axis=1) <= 0]
        kept.append(xyz.reshape(-1, 3))
    return np.concatenate(kept)


def choose_camera(meshes, options):
    """Return one camera for all meshes.

    angles:     rotation in degrees
    center:     point in the middle of the picture, in mesh coordinates
    half_width: half the side of the picture, in the unit of the mesh
    reach:      distance of the farthest drawn point from the center, likewise
    """
    rotation = choose_rotation(options.view, options.plane)
    points = np.concatenate(
        [kept_points(mesh, options.plane) for mesh in meshes])
    if not len(points):
        raise RenderError("the cut leaves no elements; move the plane or "
                          "turn its normal around.")
    if options.focus:
        center = np.array(options.focus[:3])
        half_width = options.focus[3]
    else:
        on_screen = points @ rotation.T
        low, high = on_screen.min(axis=0), on_screen.max(axis=0)
        center = rotation.T @ ((low + high) / 2)
        half_width = (1 + FIT_MARGIN) * max(high[:2] - low[:2]) / 2
    reach = np.linalg.norm(points - center, axis=1).max()
    return {"angles": angles_from_rotation(rotation),
            "center": center.tolist(),
            "half_width": float(half_width / options.zoom),
            "reach": float(reach)}


# --------------------------------------------------------------------------
# Drawing one half with Gmsh (runs in a child process)
# --------------------------------------------------------------------------

def png_size(path):
    """Return width and height of a PNG file in pixels."""
    with open(path, "rb") as stream:
        return struct.unpack(">II", stream.read(24)[16:24])


def ramp_color(position):
    """Return the colour (r, g, b) at a position from 0 (small) to 1."""
    scaled = min(max(position, 0.0), 1.0) * (len(SIZE_COLORS) - 1)
    index = min(int(scaled), len(SIZE_COLORS) - 2)
    part = scaled - index
    return tuple(round(a + part * (b - a)) for a, b in
                 zip(SIZE_COLORS[index], SIZE_COLORS[index + 1]))


def set_scene_options(gmsh):
    """Draw nothing but post-processing views, on white, softly lit."""
    numbers = {
        "General.Axes": 0, "General.SmallAxes": 0,
        "General.BackgroundGradient": 0, "General.Orthographic": 1,
        "General.Trackball": 0, "General.ClipWholeElements": 1,
        "General.Shininess": 0,
        # Light from over the viewer's shoulder.
        "General.Light0X": 0.3, "General.Light0Y": 0.5,
        "General.Light0Z": 1.0, "General.Light0W": 0,
        "Print.Text": 0, "Print.Background": 1,
    }
    numbers.update({"Geometry." + name: 0 for name in
                    ("Points", "Curves", "Surfaces", "Volumes")})
    numbers.update({"Mesh." + name: 0 for name in
                    ("Points", "Nodes", "Lines", "SurfaceEdges",
                     "SurfaceFaces", "VolumeEdges", "VolumeFaces")})
    for name, value in numbers.items():
        set_if_known(gmsh, name, value)
    colors = {"Background": 255, "Foreground": 0, "Text": 0,
              # Much light from everywhere keeps the colours comparable with
              # the legend; the rest shows the shape of the elements.
              "AmbientLight": 168, "DiffuseLight": 40, "SpecularLight": 0}
    for name, grey in colors.items():
        set_color(gmsh, "General.", name, (grey, grey, grey))


def set_if_known(gmsh, name, value):
    """Set an option unless this Gmsh has another name for it."""
    try:
        gmsh.option.setNumber(name, value)
    except Exception:  # gmsh raises plain Exception
        pass


def set_color(gmsh, prefix, name, color):
    """Set a colour option, whose name Gmsh 4.8 writes without 'Color.'."""
    try:
        gmsh.option.setColor(prefix + "Color." + name, *color)
    except Exception:  # gmsh raises plain Exception
        gmsh.option.setColor(prefix + name, *color)


def add_size_view(gmsh, mesh, job):
    """Add the view that shows the element sizes, cut by the plane."""
    for tag in gmsh.view.getTags():  # views that came with the mesh file
        hidden = gmsh.view.getIndex(tag)
        gmsh.option.setNumber(f"View[{hidden}].Visible", 0)
    view = gmsh.view.add("element size")
    gmsh.view.addHomogeneousModelData(
        view, 0, gmsh.model.getCurrent(), "ElementData", mesh.tags, mesh.sizes)
    prefix = f"View[{gmsh.view.getIndex(view)}]."
    low, high = job["range"]
    numbers = {
        "IntervalsType": 2, "ScaleType": 2, "RangeType": 2,
        "CustomMin": low, "CustomMax": high,
        # Rounding must not push the extreme elements out of the range.
        "SaturateValues": 1,
        "ShowElement": 1, "ShowScale": 0, "ShowTime": 0, "DrawSkinOnly": 1,
        "Light": 1, "LightTwoSide": 1, "LightLines": 0, "LineWidth": 1,
        "SmoothNormals": 0, "Clip": 1 if job["plane"] else 0, "Visible": 1,
    }
    for name, value in numbers.items():
        gmsh.option.setNumber(prefix + name, value)
    for name in ("Triangles", "Quadrangles", "Tetrahedra", "Hexahedra",
                 "Prisms", "Pyramids"):
        set_color(gmsh, prefix, name, OUTLINE_COLOR)
    set_color_table(gmsh, prefix, job["scratch"])


def set_color_table(gmsh, prefix, scratch):
    """Give a view the colours of the legend."""
    colors = (ramp_color(step / (COLOR_STEPS - 1))
              for step in range(COLOR_STEPS))
    table = ", ".join(f"{{{r}, {g}, {b}, 255}}" for r, g, b in colors)
    merge_script(gmsh, scratch, f"{prefix}ColorTable = {{ {table} }};")


def set_cut(gmsh, plane):
    """Keep what is behind the plane; Gmsh keeps A x + B y + C z + D >= 0."""
    if not plane:
        return
    point, normal = np.array(plane[:3]), np.array(plane[3:])
    values = [*(-normal), float(normal @ point)]
    for name, value in zip("ABCD", values):
        gmsh.option.setNumber("General.Clip0" + name, value)


def open_window(gmsh, side, probe):
    """Open Gmsh's window so that it draws `side` x `side` pixels.

    The window is larger than the drawing by the width of Gmsh's menu, which
    is not documented: write a blank picture and correct the difference.
    On a small screen the drawing may come out smaller, and not square.
    """
    wanted = {"Width": side + 200, "Height": side}
    for name, value in wanted.items():
        gmsh.option.setNumber("General.Graphics" + name, value)
    gmsh.fltk.initialize()
    for _ in range(3):
        gmsh.write(probe)
        drawn = dict(zip(("Width", "Height"), png_size(probe)))
        if set(drawn.values()) == {side}:
            break
        for name in wanted:
            wanted[name] += side - drawn[name]
            gmsh.option.setNumber("General.Graphics" + name, wanted[name])
        gmsh.graphics.draw()


def set_camera(gmsh, camera, scratch):
    """Point Gmsh's camera.

    Gmsh fits the bounding box of the model, unrotated and with a border, into
    the window and turns it about its middle.  So the camera is set by a cube
    in place of that box, around the wanted center; General.Translation and
    Scale, whose meaning differs between versions of Gmsh, are left alone.
    """
    center, reach = np.array(camera["center"]), camera["reach"]
    # A cube as large as the mesh, with a negative border for a close-up.
    limits = ", ".join(f"{middle - reach!r}, {middle + reach!r}"
                       for middle in camera["center"])
    merge_script(gmsh, scratch, f"BoundingBox {{ {limits} }};")
    border = (camera["half_width"] / reach - 1) / 2
    gmsh.option.setNumber("General.DisplayBorderFactor", border)
    for axis, angle in zip("XYZ", camera["angles"]):
        gmsh.option.setNumber("General.Rotation" + axis, angle)
    # Gmsh draws what is nearer to z = 0 than this factor times a length that
    # it takes from the box.  All of the mesh has to be drawn, but the closer
    # the limit, the better hidden elements are told from visible ones.
    own_length = max(abs(center[2]) + reach, 2 * math.sqrt(3) * reach)
    needed = abs(center[2]) + reach
    gmsh.option.setNumber("General.ClipFactor", 1.05 * needed / own_length)


def merge_script(gmsh, scratch, command):
    """Let Gmsh run a command that its Python module does not offer."""
    script = Path(scratch, "command.opt")
    script.write_text(command + "\n")
    gmsh.merge(str(script))


def draw_half(job_file):
    """Draw one mesh as the job file says and write the raw PNG."""
    job = json.loads(Path(job_file).read_text())
    gmsh = import_gmsh()
    start_gmsh(gmsh)
    set_scene_options(gmsh)
    open_window(gmsh, job["side"], str(Path(job["scratch"], "probe.png")))
    mesh = read_mesh(gmsh, job["mesh"], job["dim"], job["volumes"])
    # Opening a file sets the options that may be stored in or beside it.
    set_scene_options(gmsh)
    add_size_view(gmsh, mesh, job)
    set_cut(gmsh, job["plane"])
    set_camera(gmsh, job["camera"], job["scratch"])
    gmsh.write(job["picture"])
    gmsh.finalize()


def run_drawing(path, camera, size_range, options):
    """Draw one mesh in a child process; return a square Pillow image.

    Gmsh's window cannot be opened a second time in one process.
    """
    image_module = import_pillow()[0]
    with tempfile.TemporaryDirectory(prefix="render_cut_") as scratch:
        picture = Path(scratch, "half.png")
        job = {"mesh": str(path), "dim": options.dim, "plane": options.plane,
               "volumes": options.volumes, "camera": camera,
               "range": size_range, "scratch": scratch,
               "picture": str(picture), "side": OVERSAMPLING * PANEL_PIXELS}
        job_file = Path(scratch, "job.json")
        job_file.write_text(json.dumps(job))
        try:
            child = subprocess.run(
                [sys.executable, os.path.abspath(__file__), "--draw-half",
                 str(job_file)], stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT, timeout=DRAWING_TIMEOUT)
        except subprocess.TimeoutExpired:
            raise RenderError(
                f"Gmsh did not draw '{path}' within {DRAWING_TIMEOUT} s; "
                "draw a smaller mesh or fewer --volumes.") from None
        if child.returncode or not picture.is_file():
            lines = child.stdout.decode(errors="replace").strip().splitlines()
            reason = tidy(lines[-1]) if lines else "no message"
            raise RenderError(
                f"Gmsh could not draw '{path}' (exit code {child.returncode}: "
                f"{reason}); if its window or OpenGL is the cause, unset "
                "DISPLAY and install the Debian package libgl1-mesa-dri.")
        with image_module.open(picture) as opened:
            return middle_square(opened.convert("RGB"))


def middle_square(image):
    """Cut the square out of the middle of an image."""
    side = min(image.size)
    left, top = (image.width - side) // 2, (image.height - side) // 2
    return image.crop((left, top, left + side, top + side))


# --------------------------------------------------------------------------
# Composing the picture
# --------------------------------------------------------------------------

def load_font(size, bold=False):
    """Return a readable scalable font, `size` in pixels."""
    font_module = import_pillow()[2]
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    try:
        return font_module.truetype(name, size)
    except OSError:
        pass
    try:
        return font_module.load_default(size)  # bundled since Pillow 10.1
    except TypeError:
        raise RenderError("there is no readable font; install the Debian "
                          "package fonts-dejavu-core or a newer Pillow.") \
            from None


def fitting_font(text, size, width, bold=False):
    """Return the largest font up to `size` in which text fits the width."""
    while True:
        font = load_font(size, bold)
        if font.getlength(text) <= width or size <= 12:
            return font
        size -= 1


def trim_common(panels):
    """Shrink the panels, and cut off the white that all of them have.

    Raises RenderError if nothing is drawn in any of them.
    """
    image, _, _ = import_pillow()
    panels = [panel.resize((PANEL_PIXELS, PANEL_PIXELS), image.LANCZOS)
              for panel in panels]
    inked = np.any([np.asarray(panel).min(axis=2) < 250 for panel in panels],
                   axis=0)
    if not inked.any():
        raise RenderError("no element is in the picture; change --plane, "
                          "--focus or --zoom.")
    rows, columns = (np.flatnonzero(inked.any(axis=axis)) for axis in (1, 0))
    box = (max(columns[0] - 8, 0), max(rows[0] - 8, 0),
           min(columns[-1] + 9, PANEL_PIXELS), min(rows[-1] + 9, PANEL_PIXELS))
    return [panel.crop(tuple(map(int, box))) for panel in panels]


def compose(panels, captions, size_range):
    """Return the whole picture.

    captions: a pair (title, number of elements) of texts for each panel
    """
    image, image_draw, _ = import_pillow()
    panels = trim_common(panels)
    width, height = panels[0].size
    column = max(width, 760)  # room for titles over a slender mesh
    margin, gap, heading, legend = 30, 50, 126, 190
    total = 2 * margin + len(panels) * column + (len(panels) - 1) * gap
    picture = image.new("RGB", (total, heading + height + legend), "white")
    draw = image_draw.Draw(picture)
    longest = max((title for title, _ in captions), key=len)
    title_font = fitting_font(longest, 42, column, bold=True)
    for index, (panel, (title, count)) in enumerate(zip(panels, captions)):
        left = margin + index * (column + gap)
        picture.paste(panel, (left + (column - width) // 2, heading))
        middle = left + column / 2
        draw.text((middle, 60), title, "black", anchor="ms",
                  font=title_font)
        draw.text((middle, 104), count, (70, 70, 70), anchor="ms",
                  font=fitting_font(count, 34, column))
    draw_legend(draw, heading + height + 28, total, size_range)
    return picture


def draw_legend(draw, top, total_width, size_range):
    """Draw the colour bar with its numbers and its caption below it."""
    bar_height = 34
    width = min(total_width - 380, 1300)
    left = (total_width - width) // 2
    font = load_font(28)
    for x in range(width):
        draw.line([(left + x, top), (left + x, top + bar_height)],
                  ramp_color(x / (width - 1)))
    draw.rectangle((left, top, left + width - 1, top + bar_height),
                   outline="black")
    draw.text((left - 24, top + bar_height / 2), "small", "black",
              anchor="rm", font=font)
    draw.text((left + width + 24, top + bar_height / 2), "large", "black",
              anchor="lm", font=font)
    low, high = size_range
    for value in spaced_ticks(low, high, width, font):
        x = left + tick_position(value, low, high) * (width - 1)
        draw.line([(x, top + bar_height), (x, top + bar_height + 9)], "black",
                  2)
        draw.text((x, top + bar_height + 40), format_size(value), "black",
                  anchor="ms", font=font)
    caption = "element size = mean edge length (unit of the mesh, log scale)"
    draw.text((total_width / 2, top + bar_height + 92), caption,
              (70, 70, 70), anchor="ms",
              font=fitting_font(caption, 28, total_width - 60))


def tick_position(value, low, high):
    """Return the place of a size on the bar, from 0 to 1."""
    return math.log(value / low) / math.log(high / low)


def spaced_ticks(low, high, width, font):
    """Return the ends of the range and the round sizes with room between."""
    chosen = [low, high]
    for value in round_sizes(low, high):
        if all(abs(tick_position(value, low, high)
                   - tick_position(other, low, high)) * width
               > (font.getlength(format_size(value))
                  + font.getlength(format_size(other))) / 2 + 24
               for other in chosen):
            chosen.append(value)
    return sorted(chosen)


def round_sizes(low, high):
    """Return round sizes within a range, the most welcome first."""
    if high > 20 * low:
        steps = [1, 2, 5]
    elif high > 3 * low:
        steps = [1, 2, 5, 3, 4, 6, 8, 1.5, 2.5]
    else:
        steps = [1, 2, 5, 3, 4, 6, 7, 8, 9] + [n / 10 for n in range(11, 100)]
    exponents = range(math.floor(math.log10(low)),
                      math.ceil(math.log10(high)) + 1)
    candidates = [step * 10.0 ** exponent for step in steps
                  for exponent in exponents]
    return [value for value in candidates if low < value < high]


def format_size(value):
    """Return a size with at most three significant digits."""
    if 1e-4 <= value < 1e5:
        digits = max(0, 2 - math.floor(math.log10(value)))
        text = f"{value:.{digits}f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    number, exponent = f"{value:.2e}".split("e")
    return f"{number.rstrip('0').rstrip('.')}e{int(exponent)}"


def save_picture(picture, path):
    """Write the PNG with few colours, complete or not at all."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        for colors in PALETTE_SIZES:
            # Maximum coverage keeps the rare colours of the smallest
            # elements, k-means then lessens the mean error.
            picture.quantize(colors, method=1, kmeans=1, dither=0).save(
                part, format="PNG", optimize=True)
            if part.stat().st_size <= MAX_FILE_BYTES:
                break
        os.replace(part, path)
    except OSError as error:
        raise RenderError(f"'{path}' cannot be written ({error.strerror}); "
                          "choose another place for it.") from None
    finally:
        if part.exists():
            part.unlink()


# --------------------------------------------------------------------------
# Main program
# --------------------------------------------------------------------------

def tidy(message):
    """Return a message as one line without a full stop at its end."""
    return " ".join(str(message).split()).rstrip(".") or "no message"


def abridged(tags):
    """Return a short text for a list of tags."""
    shown = ", ".join(map(str, tags[:12]))
    return shown + (", ..." if len(tags) > 12 else "") or "none"


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
    meshes = [measure_file(gmsh, path, options) for path in options.meshes]
    size_range = common_range(meshes)
    camera = choose_camera(meshes, options)
    captions = captions_of(meshes, options)
    del meshes  # the child processes need the memory
    panels = [run_drawing(path, camera, size_range, options)
              for path in options.meshes]
    picture = compose(panels, captions, size_range)
    save_picture(picture, options.output)
    print(f"{options.output}: {picture.width} x {picture.height} pixels, "
          f"{options.output.stat().st_size / 1000:.0f} kB")


def main(arguments):
    """Run the program; return its exit code."""
    try:
        if arguments[:1] == ["--draw-half"]:  # how the program calls itself
            draw_half(arguments[1])
            return 0
        options = parse_arguments(arguments)
        import_pillow()
        import_gmsh()
        restart_under_xvfb_if_needed(arguments)
        render(options)
    except RenderError as error:
        print(f"render_cut: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
