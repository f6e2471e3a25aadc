"""What Gmsh shows: a view of the sizes, cut by a plane, seen by the camera."""

import math
from pathlib import Path

import numpy as np

from picture_file import png_size
from size_scale import ramp_color

COLOR_STEPS = 256
OUTLINE_COLOR = (40, 40, 40)


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
