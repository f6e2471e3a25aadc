"""The program ``meshgrow`` of an installed package."""

from __future__ import annotations

import glob
import importlib.util
import os
import sys
from typing import NoReturn, Optional

_HERE = os.path.dirname(os.path.abspath(__file__))


def _find_program() -> str:
    """The program beside the package (installed) or in the build tree."""
    candidates = [os.path.join(_HERE, "bin", "meshgrow"),
                  os.path.normpath(os.path.join(_HERE, "..", "..", "bin", "meshgrow"))]
    for path in candidates:
        if os.path.exists(path):
            return path
    sys.exit("meshgrow: the program was not found (looked at %s): build or install meshgrow first."
             % ", ".join(candidates))


def _libgmsh_of_python() -> Optional[str]:
    """The libgmsh of this Python's gmsh module, where a wheel puts it; the module is not loaded."""
    module = importlib.util.find_spec("gmsh")
    if module is None or module.origin is None:
        return None
    folder = os.path.dirname(os.path.realpath(module.origin))
    for _ in range(3):  # as the module itself looks for it
        for place in (folder, os.path.join(folder, "lib")):
            found = sorted(glob.glob(os.path.join(place, "libgmsh.so*")))
            if found:
                return found[-1]
        folder = os.path.dirname(folder)
    return None


def main() -> NoReturn:
    """Becomes the program, with this Python's Gmsh unless MESHGROW_GMSH_LIB names another."""
    environment = dict(os.environ)
    libgmsh = _libgmsh_of_python()
    if libgmsh is not None:
        environment.setdefault("MESHGROW_GMSH_LIB", libgmsh)
    program = _find_program()
    os.execve(program, [program] + sys.argv[1:], environment)


if __name__ == "__main__":
    main()
