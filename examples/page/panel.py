"""Draws one mesh in a process of its own, and gives its picture back."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from environment import import_gmsh, import_pillow
from errors import RenderError, tidy
from gmsh_scene import (add_size_view, open_window, set_camera, set_cut, set_scene_options)
from mesh_sizes import read_mesh, start_gmsh

# Side of one half of the picture, in pixels.
PANEL_PIXELS = 960
# Gmsh draws this many times larger; shrinking smooths the element outlines.
OVERSAMPLING = 2
# Longest time Gmsh may take to draw one half, in seconds.
DRAWING_TIMEOUT = 1800
# Of the picture that Gmsh draws, in pixels.
DRAWN_PIXELS = OVERSAMPLING * PANEL_PIXELS


def draw_here(job_file):
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


def draw_panel(path, camera, size_range, options):
    """Draw one mesh in a child process; return a square Pillow image.

    Gmsh's window cannot be opened a second time in one process.
    """
    image_module = import_pillow()[0]
    with tempfile.TemporaryDirectory(prefix="render_cut_") as scratch:
        picture = Path(scratch, "half.png")
        job = {"mesh": str(path), "dim": options.dim, "plane": options.plane,
               "volumes": options.volumes, "camera": camera,
               "range": size_range, "scratch": scratch,
               "picture": str(picture), "side": DRAWN_PIXELS}
        job_file = Path(scratch, "job.json")
        job_file.write_text(json.dumps(job))
        try:
            child = subprocess.run(
                [sys.executable, os.path.abspath(__file__), str(job_file)],
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                timeout=DRAWING_TIMEOUT)
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


if __name__ == "__main__":  # how draw_panel calls this file
    try:
        draw_here(sys.argv[1])
    except RenderError as problem:
        sys.exit(str(problem))
