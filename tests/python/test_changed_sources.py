"""A source that is meshed anew is noticed: in answers, summaries and within runs of Gmsh."""

import time

import gmsh
import meshgrow
import pytest

import models
from meshes import element_count, options, premesh


def square_with_source(length, **options_of_field):
    model = models.square(2.0)
    field = meshgrow.SizeField(**options_of_field)
    field.add_mesh([model.left], [model.face], 1.2, 1.0)
    premesh([model.left], length)
    return model, field


def size_beside(model, field):
    return field.size(*model.face, [[0.01, 1, 0]])[0]


@pytest.mark.parametrize("evaluator", ["exact", "grid"])
def test_sizes_follow_a_source_that_is_meshed_anew(evaluator):
    model, field = square_with_source(0.5, evaluator=evaluator)
    coarse = size_beside(model, field)
    assert size_beside(model, field) == coarse
    gmsh.model.mesh.clear()
    premesh([model.left], 0.05)
    assert size_beside(model, field) < 0.3 * coarse
    gmsh.model.mesh.clear()
    premesh([model.left], 0.5)
    assert size_beside(model, field) == pytest.approx(coarse)


def test_other_nodes_with_the_same_elements_are_noticed():
    model, field = square_with_source(0.5)
    before = size_beside(model, field)
    nodes = gmsh.model.mesh.getNodes(*model.left)[0]
    elements = gmsh.model.mesh.getElements(*model.left)
    gmsh.model.mesh.clear([model.left])
    heights = [0.05 * (i + 1) for i in range(len(nodes))]
    gmsh.model.mesh.addNodes(*model.left, nodes, [c for y in heights for c in (0, y, 0)])
    gmsh.model.mesh.addElements(*model.left, *elements)
    assert size_beside(model, field) != before


def test_a_source_whose_mesh_is_gone_has_no_effect_and_is_told_of():
    model, field = square_with_source(0.1)
    assert size_beside(model, field) < 0.2
    gmsh.model.mesh.clear()
    gmsh.logger.start()
    assert size_beside(model, field) == float("inf")
    assert any("has no mesh" in line for line in gmsh.logger.get())
    gmsh.logger.stop()


def test_the_summary_is_of_the_sources_as_they_are():
    model, field = square_with_source(0.5)
    few = field.statistics()["groups"][0]["facets"]
    gmsh.model.mesh.clear()
    premesh([model.left], 0.05)
    assert field.statistics()["groups"][0]["facets"] >= 5 * few


def test_sizes_within_a_run_are_those_of_the_source_as_gmsh_meshed_it():
    model = models.square(2.0)
    wanted = {"source": 0.5}
    field = meshgrow.SizeField()
    field.add_mesh([model.left], [model.face], 1.2, 1.0)
    field.combine(lambda dim, tag, x, y, z, lc: wanted["source"] if (dim, tag) == model.left else lc)
    premesh([model.left], 0.5)
    field.register()  # reads the coarse mesh
    wanted["source"] = 0.05
    gmsh.model.mesh.generate(2)  # meshes the source finely, then the face
    assert element_count(model.left) >= 30
    near = [[0.02, 1.0, 0.0]]
    assert field.size(*model.face, near)[0] < 0.1
    assert meshgrow.report(2, [model.face], field)["length_share_over_2"] < 0.02


def test_meshes_made_by_generate_itself_are_no_change():
    model = models.two_boxes()
    field = meshgrow.SizeField(evaluator="grid")
    field.add_fixed([model.between], [model.left], 0.1, 1.2, 0.5)
    field.add_mesh([model.between], [model.right], 1.2, 0.5)
    field.generate(3)

    def built():
        return [(g["facets"], g["tree_seconds"]) for g in field.statistics()["groups"]
                if any(dim == 3 for dim, _ in g["entities"])]

    before = built()
    field.size(*model.right, [[1.5, 0.5, 0.5]])
    assert built() == before


def test_a_fixed_source_volume_of_a_mesh_file_is_its_faces_meshes(tmp_path):
    """A mesh file has no geometry: faces are what their elements are."""
    model = models.two_boxes()
    premesh([model.left, model.right], 0.4)
    path = str(tmp_path / "boxes.msh")
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    gmsh.write(path)
    gmsh.clear()
    gmsh.merge(path)
    field = meshgrow.SizeField()
    field.add_fixed([model.left], [model.right], 0.1, 1.25, 5.0)
    # 0.5 from the face between the volumes: 0.1 + (1 - 1 / 1.25) * 0.5.
    assert field.exact_size(*model.right, [[1.5, 0.5, 0.5]])[0] == pytest.approx(0.2)


def test_statistics_tell_the_seconds_of_the_last_run():
    model, field = square_with_source(0.1)
    assert field.statistics()["seconds"] == {"gmsh": 0, "meshgrow": 0}
    begin = time.perf_counter()
    field.generate(2)
    elapsed = time.perf_counter() - begin
    seconds = field.statistics()["seconds"]
    assert seconds["gmsh"] > 0 and seconds["meshgrow"] > 0
    assert sum(seconds.values()) <= elapsed
