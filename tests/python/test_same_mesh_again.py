"""The same input and version, with one thread of Gmsh, make the same file, byte for byte."""

import os
import subprocess

import gmsh
import pytest

from program import PROGRAM

MODEL = """
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 0.3};
Box(2) = {-1, -1, -1, 2, 2, 2};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Mesh.MeshSizeMax = 0.3;
"""
KINDS = [
    "mesh source Surface{1} attach Volume{2} growth 1.3 limit 0.4",
    "fixed source Surface{1} attach Volume{1} size 0.1 growth 1.3 limit 0.4",
    "curvature source Volume{:} attach Volume{:} growth 1.3 limit 0.4",
    "proximity source Volume{2} attach Volume{2} cells 2 growth 1.3 limit 0.4",
]


def mesh(directory, name, arguments, threads):
    result = subprocess.run(
        [PROGRAM, "mesh", "model.geo", "-nt", "1", "-o", name, *arguments], capture_output=True,
        text=True, cwd=directory, env={**os.environ, "OMP_NUM_THREADS": str(threads)})
    assert result.returncode == 0, result.stderr
    return (directory / name).read_bytes()


@pytest.mark.parametrize("arguments", [
    [],
    [a for kind in KINDS for a in ("--size-function", kind)],
    [a for kind in KINDS for a in ("--size-function", kind)] + ["--evaluator", "grid",
                                                                "--calibrate"],
    ["--defaults", "0.3", "-order", "2"],
    ["--size-function", KINDS[0], "-algo", "hxt", "--evaluator", "grid"],
], ids=["gmsh", "four kinds", "grid", "defaults", "hxt"])
def test_the_same_mesh_again(tmp_path, arguments):
    if "hxt" in arguments and gmsh.__version__.startswith("4.8"):
        pytest.skip("HXT of Gmsh 4.8 makes another mesh each time, whoever calls it")
    (tmp_path / "model.geo").write_text(MODEL)
    first = mesh(tmp_path, "first.msh", arguments, 1)
    assert len(first) > 10000
    assert mesh(tmp_path, "again.msh", arguments, 1) == first
    for threads in (2, 5):
        assert mesh(tmp_path, "threads.msh", arguments, threads) == first, threads
