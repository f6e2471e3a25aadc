"""What has to be installed: modules, a display, or how to get them."""

import os
import shutil
import sys
from pathlib import Path

from errors import RenderError

PROGRAM = Path(sys.argv[0]).stem

try:
    import numpy  # noqa: F401  (all modules here need it)
except ImportError:
    sys.exit(f"{PROGRAM}: numpy is missing; install the Debian package python3-numpy or run "
             "'pip install numpy'.")


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


def import_matplotlib():
    """Return matplotlib's Figure, which draws without a window, and its tick classes."""
    try:
        from matplotlib import ticker
        from matplotlib.figure import Figure
    except ImportError:
        raise RenderError("matplotlib is missing; run 'pip install matplotlib'.") from None
    return Figure, ticker


def restart_under_xvfb_if_needed(side):
    """Without a display, run this program again under xvfb-run.

    Gmsh draws into a window, so it needs an X server even for a file.
    side: of the drawing, in pixels
    """
    if sys.platform in ("darwin", "win32") or os.environ.get("DISPLAY"):
        return
    for program, package in (("xvfb-run", "xvfb"), ("xauth", "xauth")):
        if not shutil.which(program):
            raise RenderError(
                f"there is no display and {program} is missing; install the "
                f"Debian package {package} or set DISPLAY.")
    # Room for the drawing and for Gmsh's menus around it.
    screen = f"-screen 0 {side + 600}x{side + 300}x24"
    environment = dict(os.environ, FLTK_BACKEND="x11")
    sys.stdout.flush()
    os.execvpe("xvfb-run",
               ["xvfb-run", "-a", "-s", screen, sys.executable,
                os.path.abspath(sys.argv[0]), *sys.argv[1:]], environment)
