"""A child process whose libgmsh fails or is interrupted at a call of one's choice (faulty_gmsh.c)."""

import ctypes
import os
import shutil
import subprocess

import gmsh
import pytest

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "faulty_gmsh.c")
FAIL_BEFORE, FAIL_AFTER, INTERRUPT_BEFORE, INTERRUPT_AFTER, FAIL_EVER_AFTER = range(1, 6)


def build(directory):
    """Path of the library, for the Gmsh of this process."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    path = os.path.join(str(directory), "libgmsh-faulty.so")
    since_49 = ["-DSINCE_49"] if hasattr(gmsh.model.mesh, "getMaxNodeTag") else []
    subprocess.run([compiler, "-O1", "-shared", "-fPIC", *since_49, "-o", path, SOURCE, "-ldl"],
                   check=True)
    return path


def environment(path):
    """Of a process that is to use it."""
    return {"FAULTY_LIB": path, "REAL_GMSH_LIB": gmsh.lib._name, "MESHGROW_GMSH_LIB": path}


class Faulty:
    """Within the child; make it before gmsh is imported: meshgrow takes the first libgmsh."""

    def __init__(self):
        # Newer modules gmsh load theirs for all to see.
        self.library = ctypes.CDLL(os.environ["FAULTY_LIB"], mode=ctypes.RTLD_GLOBAL)
        self.library.faulty_name.restype = ctypes.c_char_p
        self.library.faulty_count.restype = ctypes.c_long

    def arm(self, call, action=FAIL_BEFORE, name=""):
        """Let this call of the function, of all functions if it has no name, fail; 0: none."""
        self.library.faulty_arm(name.encode(), ctypes.c_long(call), action)

    def calls(self):
        """The names of the functions called since it was armed."""
        return [self.library.faulty_name(ctypes.c_long(i)).decode()
                for i in range(self.library.faulty_count())]
