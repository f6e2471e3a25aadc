"""The workflow for continuous integration and the .geo that it meshes do work."""

import json
import os
import pathlib
import shutil
import subprocess

import gmsh
import pytest

from program import PROGRAM

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"


def commands_of(step):
    """The lines of the step's block `run: |`."""
    lines = (EXAMPLES / "ci" / "meshing.yml").read_text().splitlines()
    begin = lines.index("      - name: " + step) + 1
    assert lines[begin] == "        run: |"
    block = []
    for line in lines[begin + 1:]:
        if line.strip() and not line.startswith(" " * 10):
            break
        block.append(line[10:])
    return "\n".join(block)


def run_step(directory, text):
    path = os.pathsep.join([os.path.dirname(os.path.abspath(PROGRAM)), os.environ["PATH"]])
    return subprocess.run(["bash", "-e", "-c", text], cwd=directory, capture_output=True,
                          text=True, env={**os.environ, "PATH": path})


@pytest.fixture
def directory(tmp_path):
    shutil.copy(EXAMPLES / "size_functions.geo", tmp_path)
    return tmp_path


def test_the_step_accepts_the_example_and_leaves_what_is_uploaded(directory):
    result = run_step(directory, commands_of("Mesh"))
    assert result.returncode == 0, result.stderr
    row, = json.loads((directory / "report.json").read_text())
    assert row["failed"] == [] and row["report"]["elements"] > 50000
    assert (directory / "size_functions.msh").stat().st_size > 1000000


def test_the_step_refuses_a_bad_mesh(directory):
    text = commands_of("Mesh").replace("gamma_min < 0.05", "gamma_min < 0.99")
    result = run_step(directory, text.replace("-3 ", "-3 -setnumber growth 2 "))
    assert result.returncode == 1
    assert "'gamma_min < 0.99' holds" in result.stderr
    assert json.loads((directory / "report.json").read_text())[0]["failed"]


def test_stock_gmsh_shows_the_definitions_and_ignores_them(directory):
    gmsh.open(str(directory / "size_functions.geo"))
    assert sorted(gmsh.onelab.getNames("^Size functions/")) == ["Size functions/block",
                                                                "Size functions/pipe"]
    gmsh.model.mesh.generate(2)
    assert len(gmsh.model.mesh.getNodes()[0]) < 3000
