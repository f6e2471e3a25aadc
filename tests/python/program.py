"""The program `meshgrow`, for the tests that run it."""

import os
import subprocess

PROGRAM = os.environ.get("MESHGROW_PROGRAM", "meshgrow")


def run(*arguments, **environment):
    """Its result, with what it printed as text."""
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          env={**os.environ, **environment})
