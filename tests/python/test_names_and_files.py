"""Names of size functions, changes by name, and files of fields, from Python."""

import meshgrow
import pytest

import models
from meshes import random_points


def beside(model, field):
    return field.exact_size(*model.face, [[0.5, 0.0, 0.0]])[0]


def test_functions_are_named_and_numbered():
    model = models.square()
    field = meshgrow.SizeField()
    assert field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3) == "1"
    assert field.add_mesh([model.top], [model.face], 1.2, 0.3, name="inner wall") == "inner wall"
    assert field.add("fixed source Curve{1} attach Surface{1} size 0.1 growth 1.2 limit 1 "
                     "name fine") == "fine"
    assert field.add_curvature([model.top], [model.face], size_limit=0.3, name="c") == "c"
    assert field.add_proximity([model.face], [model.face], size_limit=0.3, name="p") == "p"
    functions = field.functions()
    assert list(functions) == ["1", "inner wall", "fine", "c", "p"]
    assert functions["fine"].startswith("fixed ") and "size 0.1" in functions["fine"]


def test_a_name_that_cannot_be_had_adds_nothing():
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3, name="a")
    with pytest.raises(meshgrow.Error, match="a"):
        field.add_fixed([model.top], [model.face], 0.02, 1.2, 0.3, name="a")
    assert list(field.functions()) == ["a"]


def test_functions_are_modified_renamed_and_removed():
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3, name="a")
    field.add_fixed([model.bottom], [model.face], 0.2, 1.2, 0.3, name="b")
    assert beside(model, field) == pytest.approx(0.05)
    field.modify("a", field.functions()["a"].replace("0.05", "0.1"))
    assert beside(model, field) == pytest.approx(0.1)
    field.rename("a", "c")
    assert list(field.functions()) == ["c", "b"]
    field.remove("c")
    assert beside(model, field) == pytest.approx(0.2)
    for change in (field.remove, lambda name: field.rename(name, "d"),
                   lambda name: field.modify(name, field.functions()["b"])):
        with pytest.raises(meshgrow.Error, match="c"):
            change("c")


def test_a_loaded_field_answers_the_same_and_cannot_be_changed(tmp_path):
    model = models.square()
    field = meshgrow.SizeField(evaluator="grid")
    field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
    path = tmp_path / "größen.mgf"
    field.save(path)
    loaded = meshgrow.SizeField.load(path)
    points = random_points(1000, (0, 0, 0), (1, 1, 0))
    assert (loaded.size(*model.face, points) == field.size(*model.face, points)).all()
    assert loaded.functions() == field.functions()
    for change in (lambda: loaded.add_fixed([model.top], [model.face], 0.1, 1.2, 0.3),
                   lambda: loaded.remove("1"), lambda: loaded.generate(2)):
        with pytest.raises(meshgrow.Error, match="mgf"):
            change()


def test_a_file_that_is_not_there_is_told(tmp_path):
    with pytest.raises(meshgrow.Error, match="nothing.mgf"):
        meshgrow.SizeField.load(tmp_path / "nothing.mgf")
