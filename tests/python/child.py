"""Python code in a process of its own."""

import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))


def run_child(code, **environment):
    """Lines that the code prints; it may import the helpers. Fails if it does not end with 0."""
    path = os.pathsep.join([HERE, os.environ.get("PYTHONPATH", "")])
    child = subprocess.run([sys.executable, "-c", code],
                           env=dict(os.environ, PYTHONPATH=path, **environment),
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120)
    assert child.returncode == 0, "exit code %d\n%s" % (child.returncode, child.stderr[-2000:])
    return child.stdout.splitlines()


def told(call, *arguments):
    """Within a child: prints the sentence of the error that a call raises, or that there is none."""
    import meshgrow  # the child loads gmsh first

    try:
        call(*arguments)
    except meshgrow.Error as error:
        print("Error:", error)
    else:
        print("no error")
