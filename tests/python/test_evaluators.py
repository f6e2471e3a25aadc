"""Who answers sizes: the tree, or a grid where the mesher asks for so many sizes that it pays."""

import gmsh
import meshgrow
import pytest

import meshes
import models

DELAUNAY, HXT = 1, 10


def premeshed_sphere_in_box(algorithm):
    """With faces that are not meshed but for the sphere."""
    model = models.sphere_in_box(3.0)
    meshes.premesh([model.sphere], 0.05)
    gmsh.option.setNumber("Mesh.Algorithm3D", algorithm)
    return model


def field_of(model, **options):
    field = meshgrow.SizeField(threads=2, **options)
    field.add_mesh([model.sphere], [model.outer], 1.2, 0.5)
    return field


def group_of(field, volume):
    return next(g for g in field.statistics()["groups"] if list(volume) in g["entities"])


@pytest.mark.parametrize("algorithm, has_grid", [(DELAUNAY, False), (HXT, True)])
def test_auto_builds_a_grid_for_the_mesher_that_asks_for_many_sizes(algorithm, has_grid):
    model = premeshed_sphere_in_box(algorithm)
    field = field_of(model)
    field.generate(3)
    group = group_of(field, model.outer)
    assert (group["grid"] is not None) == has_grid
    assert group["answers"] > 0
    assert (group["exact_answers"] < group["answers"]) == has_grid
    assert "sizes answered" in field.summary()


def test_auto_builds_a_grid_when_registered():
    model = premeshed_sphere_in_box(HXT)
    field = field_of(model)
    field.refresh()
    assert group_of(field, model.outer)["grid"] is None, "nobody is about to mesh"
    field.register()
    assert group_of(field, model.outer)["grid"] is not None
    field.unregister()


def test_cells_outside_the_volume_are_not_refined_once_its_faces_are_meshed():
    model = premeshed_sphere_in_box(HXT)
    cells = []
    for faces_are_meshed in (False, True):
        if faces_are_meshed:
            field_of(model).generate(2)
        field = field_of(model)
        field.register()
        grid = group_of(field, model.outer)["grid"]
        field.unregister()
        cells.append(grid["interpolated_cells"] + grid["exact_cells"])
    # The inside of the sphere is outside of the volume.
    assert cells[1] < 0.9 * cells[0], cells


@pytest.mark.parametrize("evaluator, has_grid", [("grid", True), ("exact", False)])
def test_the_others_are_forced(evaluator, has_grid):
    model = premeshed_sphere_in_box(DELAUNAY)
    field = field_of(model, evaluator=evaluator)
    field.refresh()
    assert (group_of(field, model.outer)["grid"] is not None) == has_grid
