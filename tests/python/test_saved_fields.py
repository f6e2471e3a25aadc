"""Saved fields where users meet them: damaged ones, in other processes, beside options."""

import copy
import pickle
import subprocess
import sys

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from meshes import random_points
from program import PROGRAM


@pytest.fixture
def saved(tmp_path):
    """A model in Gmsh, and the file of a field of it."""
    model = models.two_boxes()
    field = meshgrow.SizeField(evaluator="grid")
    field.add_fixed([model.between], [model.left, model.right], 0.05, 1.2, 0.5)
    path = tmp_path / "sizes ü.mgf"
    field.save(path)
    return model, field, path


def damage(path):
    """Spoils the arrays, not what tells where they are; returns the other file."""
    data = bytearray(path.read_bytes())
    directory = int.from_bytes(data[24:32], "little")
    for place in range(80, directory, 64):
        data[place] ^= 1
    damaged = path.with_name("damaged.mgf")
    damaged.write_bytes(data)
    return damaged


def test_a_damaged_field_is_told_by_each_use(saved):
    model, _, path = saved
    field = meshgrow.SizeField.load(damage(path))  # the description is as it was
    for use in (lambda: field.size(*model.left, [[0.5, 0.5, 0.5]]),
                lambda: field.smallest_size([[0.5, 0.5, 0.5]]),
                lambda: field.save(path.with_name("again.mgf"))):
        with pytest.raises(meshgrow.Error, match="is damaged"):
            use()
    assert not path.with_name("again.mgf").exists()


@pytest.mark.parametrize("by", ["register", "callback"])
def test_gmsh_is_warned_of_a_damaged_field(saved, by):
    _, _, path = saved
    field = meshgrow.SizeField.load(damage(path))
    if by == "register":
        field.register()
    else:
        gmsh.model.mesh.setSizeCallback(field)
    gmsh.logger.start()
    gmsh.model.mesh.generate(1)
    told = [line for line in gmsh.logger.get() if "is damaged" in line]
    gmsh.logger.stop()
    assert len(told) == 1 and told[0].startswith("Warning")


def test_a_server_of_a_damaged_field_goes_on_without_sizes(saved):
    _, _, path = saved
    points = np.array([[0.5, 0.5, 0.5], [0.2, 0.5, 0.5], [np.nan, 0.0, 0.0]])
    result = subprocess.run([PROGRAM, "serve", damage(path)], input=points.tobytes(),
                            capture_output=True, timeout=60)
    assert np.frombuffer(result.stdout).tolist() == [1e22, 1e22]
    assert result.returncode == 1 and result.stderr.count(b"is damaged") == 1


def test_loaded_fields_are_copied_and_sent_by_their_path(saved):
    model, field, path = saved
    points = random_points(100, 0, 1)
    expected = field.size(*model.left, points)
    loaded = meshgrow.SizeField.load(path)
    for other in (copy.copy(loaded), copy.deepcopy(loaded), pickle.loads(pickle.dumps(loaded))):
        assert np.array_equal(other.size(*model.left, points), expected)
        del other
    assert np.array_equal(loaded.size(*model.left, points), expected)
    child = subprocess.run(
        [sys.executable, "-c", "import pickle, sys; field = pickle.load(sys.stdin.buffer); "
         "print(repr(float(field.size(%d, %d, [[0.5, 0.5, 0.5]])[0])))" % model.left],
        input=pickle.dumps(loaded), capture_output=True, check=True)
    assert float(child.stdout) == loaded.size(*model.left, [[0.5, 0.5, 0.5]])[0]


@pytest.mark.parametrize("way", [copy.copy, copy.deepcopy, pickle.dumps])
def test_a_field_of_a_model_is_not_copied(saved, way):
    with pytest.raises(TypeError, match="save it"):
        way(saved[1])


def test_the_program_refuses_options_that_a_saved_field_cannot_heed(saved):
    _, _, path = saved
    for command in (["probe", path, "--at", "0.5,0.5,0.5", "--evaluator", "exact"],
                    ["probe", path, "--at", "0.5,0.5,0.5", "-2"],
                    ["field", path, "-o", path.with_name("b.vtu"), "--tolerance", "0.01"],
                    ["mesh", path], ["report", path]):
        result = subprocess.run([PROGRAM, *map(str, command)], capture_output=True, text=True)
        assert result.returncode == 2 and "saved size field" in result.stderr, command
    field = meshgrow.SizeField.load(path)
    with pytest.raises(meshgrow.Error, match="keeps its tolerance"):
        field._set("tolerance", 0.1)


def test_strict_holds_at_every_use():
    model = models.two_boxes()
    field = meshgrow.SizeField(strict=True)
    field.add_mesh([model.between], [model.right], 1.2, 0.5)
    for _ in range(2):
        with pytest.raises(meshgrow.Error, match="no mesh"):
            field.size(*model.right, [[1.5, 0.5, 0.5]])


@pytest.mark.parametrize("name", ["", "7", 'a"b', "a\nb", "a\0b"])
def test_names_that_would_break_a_line_are_refused(saved, name):
    model, field, _ = saved
    with pytest.raises((meshgrow.Error, ValueError)):
        field.add_fixed([model.between], [model.left], 0.1, 1.2, 0.5, name=name)
    assert list(field.functions()) == ["1"]


def test_a_model_with_other_entities_is_noticed(saved):
    model, field, _ = saved
    gmsh.model.occ.addBox(5, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    with pytest.raises(meshgrow.Error, match="other entities"):
        field.size(*model.left, [[0.5, 0.5, 0.5]])
