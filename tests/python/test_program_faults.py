"""The program when a call of Gmsh fails or is interrupted: reading, every pass, adjusting, writing."""

import signal

import pytest

import faulty
from program import run

MODEL = """
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 0.3};
Box(2) = {-1, -1, -1, 2, 2, 2};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Transfinite Surface{2};
"""
FUNCTIONS = ["fixed source Surface{1} attach Volume{:} size 0.2 growth 1.5 limit 0.6",
             "mesh source Surface{1} attach Volume{2} growth 1.5 limit 0.6",
             "fixed source Curve{5} attach Surface{2} size 0.1 growth 1.5 limit 0.6"]


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return faulty.build(tmp_path_factory.mktemp("faulty"))


@pytest.fixture
def directory(tmp_path):
    (tmp_path / "model.geo").write_text(MODEL)
    (tmp_path / "out.msh").write_text("of before")
    return tmp_path


def mesh(directory, library, name, call, action):
    arguments = [x for f in FUNCTIONS for x in ("--size-function", f)]
    return run("mesh", directory / "model.geo", "-3", "-o", directory / "out.msh", "-nt", "1",
               *arguments, **faulty.environment(library),
               FAULTY_GMSH="%s %d %d" % (name, call, action))


def assert_files_are_as_before(directory):
    assert (directory / "out.msh").read_text() == "of before"
    assert sorted(p.name for p in directory.iterdir()) == ["model.geo", "out.msh"]


def test_the_model_has_something_to_adjust(directory, library):
    result = mesh(directory, library, "none", 0, 0)
    assert result.returncode == 0
    assert "Adjusted Curve" in result.stdout


READING = [("gmshOpen", 1), ("gmshModelGetBoundary", 3), ("gmshModelMeshGetNodes", 9),
           ("gmshModelMeshGetElements", 9)]
# In their order: curves, surface, curves, adjusting twice, surfaces, volumes.
PASSES = [("gmshModelMeshGenerate", number) for number in range(1, 8)]
QUESTIONS = [("size1", 7), ("size2", 3), ("size3", 3)]
WRITING = [("gmshWrite", 2)]  # the first write is of mesh constraints


@pytest.mark.parametrize("name, call", READING + PASSES[3:4] + QUESTIONS + WRITING)
def test_an_interrupt_anywhere_ends_the_program_and_leaves_files_as_they_were(directory, library,
                                                                              name, call):
    result = mesh(directory, library, name, call, faulty.INTERRUPT_AFTER)
    assert result.returncode == 128 + signal.SIGINT
    assert result.stderr.splitlines()[-1] == "meshgrow: Interrupted: no mesh was written."
    assert_files_are_as_before(directory)


@pytest.mark.parametrize("name, call, action", [
    *((*place, faulty.FAIL_BEFORE) for place in READING + PASSES + WRITING),
    (*WRITING[0], faulty.FAIL_AFTER)])
def test_an_error_anywhere_is_told_and_leaves_files_as_they_were(directory, library, name, call,
                                                                 action):
    result = mesh(directory, library, name, call, action)
    assert result.returncode == (2 if name == "gmshOpen" else 1)  # as for a wrong file
    assert name in result.stderr
    assert_files_are_as_before(directory)


def test_an_interrupt_after_the_mesh_was_written_says_so_and_the_mesh_stays(directory, library):
    result = mesh(directory, library, "gmshFinalize", 1, faulty.INTERRUPT_BEFORE)
    assert result.returncode == 128 + signal.SIGINT
    assert "after the mesh was written" in result.stderr
    assert (directory / "out.msh").stat().st_size > 10000
