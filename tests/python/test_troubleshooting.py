"""Symptoms of README.md's "Troubleshooting": their causes make them, the remedies help."""

import os
import pathlib
import subprocess

import gmsh
import meshgrow
import pytest

import meshes
import models
from program import PROGRAM

README = (pathlib.Path(__file__).parents[2] / "README.md").read_text()


@pytest.fixture
def boxes():
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
    return models.two_boxes()


def grown(boxes, **options):
    field = meshgrow.SizeField(**options)
    field.add_mesh([boxes.between], [boxes.right], 1.2, 0.5)
    return field


def mentions(message):
    assert message in " ".join(README.split()), "README.md does not quote %r" % message


def test_a_source_without_a_mesh_has_no_effect_and_strict_says_so(boxes):
    gmsh.logger.start()
    field = grown(boxes)
    field.refresh()
    assert "no effect: its sources have no mesh yet" in field.summary()
    mentions("no effect: its sources have no mesh yet")
    assert any("has no mesh, so the function has no effect" in line for line in gmsh.logger.get())
    with pytest.raises(meshgrow.Error, match="mesh the source before"):
        grown(boxes, strict=True).refresh()


def test_what_has_a_mesh_keeps_it_until_it_is_meshed_again(boxes):
    meshes.premesh([boxes.between], 0.05)
    plain = meshgrow.SizeField()
    plain.generate(3)
    coarse = meshes.element_count(boxes.right)
    field = grown(boxes)
    field.generate(3)
    assert meshes.element_count(boxes.right) == coarse
    field.generate(3, remesh=True)
    assert meshes.element_count(boxes.right) > 1.3 * coarse


def test_a_later_callback_takes_the_place_of_the_field(boxes):
    meshes.premesh([boxes.between], 0.05)
    asked = []
    grown(boxes).register()
    gmsh.model.mesh.setSizeCallback(lambda dim, *_: asked.append(dim) or 0.5)
    gmsh.model.mesh.generate(3)
    assert asked and meshes.element_count(boxes.right) < 1000


def test_gmsh_itself_replaces_the_mesh_of_a_surface_and_generate_keeps_it(boxes):
    meshes.premesh([boxes.between], 0.05)
    given = meshes.snapshot(boxes.between)
    field = grown(boxes)
    field.generate(3)
    assert meshes.snapshot(boxes.between) == given
    gmsh.model.mesh.generate(3)
    assert meshes.snapshot(boxes.between) != given


def test_one_small_element_of_the_source_rules_and_probe_names_it(boxes):
    meshes.premesh([boxes.between], lambda x, y, z: 0.02 if y + z < 0.1 else 0.2)
    field = grown(boxes)
    field.refresh()
    small = field.size(*boxes.right, [(1.05, 0.05, 0.05)])[0]
    assert small < 0.06
    assert field.probe(*boxes.right, (1.05, 0.05, 0.05))["size"] == pytest.approx(small)


def test_edges_are_longer_than_the_size_without_calibration(boxes):
    median = {}
    for calibrate in (False, True):
        gmsh.model.mesh.clear()
        meshes.premesh([boxes.between], 0.05)
        field = grown(boxes, calibrate=calibrate)
        field.generate(3)
        median[calibrate] = meshgrow.report(3, [boxes.right], field)["length_median"]
    assert median[False] > 1.15 and median[True] < 1.08


def test_a_smallest_size_of_gmsh_acts_on_every_size(boxes):
    count = {}
    for smallest in (0.0, 0.3):
        gmsh.model.mesh.clear()
        meshes.premesh([boxes.between], 0.05)
        gmsh.option.setNumber("Mesh.MeshSizeMin", smallest)
        field = grown(boxes)
        field.generate(3)
        gmsh.option.setNumber("Mesh.MeshSizeMin", 0)
        count[smallest] = meshes.element_count(boxes.right)
    assert count[0.3] < 0.8 * count[0.0]


def test_meshers_that_ask_for_no_sizes_are_named(boxes):
    meshes.premesh([boxes.between], 0.1)
    gmsh.option.setNumber("Mesh.Algorithm", 7)
    gmsh.logger.start()
    grown(boxes).generate(2)
    assert any("BAMG), which asks for no sizes" in line for line in gmsh.logger.get())


def test_a_field_does_not_outlive_a_change_of_the_geometry(boxes):
    field = grown(boxes)
    gmsh.model.occ.addPoint(5, 5, 5)
    gmsh.model.occ.synchronize()
    with pytest.raises(meshgrow.Error, match="other entities than when this size field was made"):
        field.generate(3)
    mentions("other entities than when this size field was made")


def test_a_field_does_not_outlive_a_model_that_is_built_anew_with_the_same_tags():
    volume = models.box(1.0)
    field = meshgrow.SizeField()
    field.add_fixed([volume], [volume], 0.1, 1.2, 0.5)
    gmsh.model.remove()
    assert models.box(2.0) == volume
    with pytest.raises(meshgrow.Error, match="is not where it was when this size field was made"):
        field.refresh()
    mentions("is not where it was when this size field was made")


def test_a_scanned_surface_that_lost_its_mesh_is_not_meshed_again(boxes):
    gmsh.model.add("scan")
    surface = gmsh.model.addDiscreteEntity(2)
    gmsh.model.mesh.addNodes(2, surface, [1, 2, 3], [0, 0, 0, 1, 0, 0, 0, 1, 0])
    gmsh.model.mesh.addElementsByType(surface, 2, [1], [1, 2, 3])
    field = meshgrow.SizeField()
    field.add_fixed([(2, surface)], [(2, surface)], 0.1, 1.2, 0.5)
    gmsh.model.mesh.clear()
    with pytest.raises(meshgrow.Error, match="came with a mesh and has no geometry, and Gmsh did"):
        field.generate(2)
    mentions("came with a mesh and has no geometry, and Gmsh did not mesh it again")


def test_a_device_is_refused_as_output(tmp_path):
    (tmp_path / "box.geo").write_text('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1};')
    result = subprocess.run([PROGRAM, "mesh", "box.geo", "-o", "/dev/null"], cwd=tmp_path, text=True,
                            capture_output=True)
    assert result.returncode == 2 and "Cannot write /dev/null" in result.stderr
    mentions("Cannot write")


def test_a_saved_field_cannot_be_changed(boxes, tmp_path):
    meshes.premesh([boxes.between], 0.1)
    field = grown(boxes)
    field.save(tmp_path / "sizes.mgf")
    with pytest.raises(meshgrow.Error, match="cannot be changed"):
        meshgrow.SizeField.load(tmp_path / "sizes.mgf").remove("1")
    mentions("cannot be changed")


def test_a_program_without_a_libgmsh_says_what_to_set(tmp_path):
    result = subprocess.run([PROGRAM, "mesh", "x.geo"], cwd=tmp_path, text=True,
                            env={**os.environ, "MESHGROW_GMSH_LIB": "/no/libgmsh.so"},
                            capture_output=True)
    assert result.returncode == 1 and "MESHGROW_GMSH_LIB does not name a libgmsh" in result.stderr
    mentions("MESHGROW_GMSH_LIB")
