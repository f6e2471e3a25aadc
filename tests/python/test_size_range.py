"""Mesh.MeshSizeMin, Max and Factor and Gmsh's scales act as Gmsh users expect."""

import gmsh
import meshgrow
import pytest

import models
from meshes import element_count, options, premesh, snapshots


def sphere_in_box(algorithm=1, **values):
    """The box around a sphere premeshed with 0.2, meshed; its report and number of elements."""
    model = models.sphere_in_box(4.0)
    premesh([model.sphere], 0.2)
    field = meshgrow.SizeField()
    field.add_mesh([model.sphere], [model.outer], 1.2, 0.5)
    with options(Mesh_Algorithm3D=algorithm, **values):
        field.generate(3)
        return meshgrow.report(3, [model.outer], field)


@pytest.mark.parametrize("algorithm", [1, 10], ids=["Delaunay", "HXT"])
def test_the_factor_scales_the_growth_but_not_the_start_on_a_premeshed_source(algorithm):
    plain = sphere_in_box(algorithm)
    for factor in (0.7, 1.4):
        scaled = sphere_in_box(algorithm, Mesh_MeshSizeFactor=factor)
        # No jump beside the source, whatever the factor.
        assert scaled["ratio_99"] < 1.45
        assert scaled["length_median"] == pytest.approx(plain["length_median"], rel=0.1)
        assert (scaled["elements"] < plain["elements"]) == (factor > 1)


def test_the_factor_scales_prescribed_sizes_and_what_grows_from_them_alike():
    elements = []
    for factor in (1.0, 0.5):
        model = models.square(2.0)
        field = meshgrow.SizeField()
        field.add_fixed([model.left], [model.left], 0.1, 1.0, 0.1)
        field.add_mesh([model.left], [model.face], 1.2, 0.5)
        with options(Mesh_MeshSizeFactor=factor):
            field.generate(2)
        elements.append(element_count(model.face))
    # Half the size everywhere: four times as many triangles.
    assert elements[1] == pytest.approx(4 * elements[0], rel=0.25)


def test_a_changed_factor_is_read_with_the_next_size():
    model = models.square(2.0)
    premesh([model.left], 0.1)
    field = meshgrow.SizeField()
    field.add_mesh([model.left], [model.face], 1.2, 0.5)
    point = [[0.0, 1.0, 0.0]]
    assert field.size(*model.face, point)[0] == pytest.approx(0.1, rel=0.06)
    with options(Mesh_MeshSizeFactor=2.0):
        # Gmsh doubles it.
        assert field.size(*model.face, point)[0] == pytest.approx(0.05, rel=0.06)


def test_the_smallest_and_the_largest_size_limit_the_field():
    fine = sphere_in_box(Mesh_MeshSizeMax=0.25)
    assert fine["largest_size"] < 0.45 and fine["length_median"] == pytest.approx(1.3, abs=0.1)
    coarse = sphere_in_box(Mesh_MeshSizeMin=0.45)
    assert coarse["elements"] < sphere_in_box()["elements"]


def test_a_scale_of_the_written_mesh_changes_no_size(tmp_path):
    model = models.square(2.0)
    premesh([model.left], 0.1)
    before = snapshots([model.left])
    field = meshgrow.SizeField()
    field.add_mesh([model.left], [model.face], 1.2, 0.5)
    with options(Mesh_ScalingFactor=0.001):
        field.generate(2)
        gmsh.write(str(tmp_path / "scaled.msh"))
    assert snapshots([model.left]) == before
    count = element_count(model.face)
    largest = meshgrow.report(2, [model.face])["largest_size"]
    gmsh.open(str(tmp_path / "scaled.msh"))
    assert element_count((2, 1)) == count
    assert meshgrow.report(2)["largest_size"] == pytest.approx(0.001 * largest)


def test_geometry_read_in_another_unit_has_its_sizes_in_that_unit(tmp_path):
    models.box(1.0)
    gmsh.write(str(tmp_path / "box.step"))
    target = gmsh.option.getString("Geometry.OCCTargetUnit")
    gmsh.option.setString("Geometry.OCCTargetUnit", "M")
    gmsh.model.add("in metres")
    gmsh.open(str(tmp_path / "box.step"))
    gmsh.option.setString("Geometry.OCCTargetUnit", target)
    side = gmsh.model.getBoundingBox(3, 1)[3]
    assert side == pytest.approx(0.001, rel=0.01)
    field = meshgrow.SizeField()
    field.add_fixed([(3, 1)], [(3, 1)], 0.0002, 1.2, 0.0002)
    field.generate(3)
    assert meshgrow.report(3, (), field)["length_median"] == pytest.approx(1.0, abs=0.15)
