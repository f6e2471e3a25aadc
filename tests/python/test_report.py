"""report() against numpy."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from meshes import corner_tags, corners, node_positions, premesh, signed_volumes

TET_EDGES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
TRIANGLE_EDGES = [(0, 1), (1, 2), (2, 0)]


@pytest.fixture
def meshed_box():
    """A small graded box and its field."""
    volume = models.box(1.0)
    face = models.faces_of(volume[1])[0]
    field = meshgrow.SizeField()
    field.add_fixed([face], [volume], 0.12, 1.4, 0.6)
    field.generate(3)
    return volume, face, field


def mean_edges(points, edges):
    return np.mean([np.linalg.norm(points[:, i] - points[:, j], axis=1) for i, j in edges], axis=0)


def neighbour_ratios(tags, sizes, side):
    """Ratios of sizes of elements that share all but one of their nodes (`side` nodes)."""
    owners = {}
    for number, nodes in enumerate(tags):
        for left_out in range(side + 1):
            owners.setdefault(frozenset(np.delete(nodes, left_out)), []).append(number)
    pairs = np.array([pair for pair in owners.values() if len(pair) == 2])
    a, b = sizes[pairs].T
    return np.maximum(a, b) / np.minimum(a, b)


def edges_of(tags, edges):
    pairs = np.sort(np.concatenate([tags[:, list(e)] for e in edges]), axis=1)
    return np.unique(pairs, axis=0)


def relative_lengths(entity, tags, edges, field):
    positions = node_positions()
    a, b = positions[edges_of(tags, edges).T]
    asked = field.size(*entity, (a + b) / 2)
    return np.linalg.norm(b - a, axis=1) / asked


def test_sizes_and_ratios_of_tetrahedra(meshed_box):
    volume, _, field = meshed_box
    tags = corner_tags(volume, "Tetrahedron")
    sizes = mean_edges(corners(volume, "Tetrahedron"), TET_EDGES)
    ratios = neighbour_ratios(tags, sizes, 3)
    report = meshgrow.report(3)
    assert report["elements"] == len(tags)
    assert report["smallest_size"] == pytest.approx(sizes.min(), rel=1e-12)
    assert report["largest_size"] == pytest.approx(sizes.max(), rel=1e-12)
    assert report["ratio_max"] == pytest.approx(ratios.max(), rel=1e-12)
    assert report["ratio_99"] == pytest.approx(np.quantile(ratios, 0.99), rel=0.01)


def test_sizes_and_ratios_of_triangles(meshed_box):
    _, face, _ = meshed_box
    tags = corner_tags(face, "Triangle")
    sizes = mean_edges(corners(face, "Triangle"), TRIANGLE_EDGES)
    ratios = neighbour_ratios(tags, sizes, 2)
    report = meshgrow.report(2, [face])
    assert report["elements"] == len(tags)
    assert report["ratio_max"] == pytest.approx(ratios.max(), rel=1e-12)
    assert report["smallest_size"] == pytest.approx(sizes.min(), rel=1e-12)


def test_lengths_against_the_sizes_asked_for(meshed_box):
    volume, _, field = meshed_box
    lengths = relative_lengths(volume, corner_tags(volume, "Tetrahedron"), TET_EDGES, field)
    report = meshgrow.report(3, [volume], field)
    assert report["length_median"] == pytest.approx(np.median(lengths), rel=0.01)
    good = np.mean((lengths > np.sqrt(0.5)) & (lengths <= np.sqrt(2)))
    assert report["length_share_good"] == pytest.approx(good, abs=2 / len(lengths))
    assert report["length_share_over_2"] == pytest.approx(np.mean(lengths > 2), abs=1e-12)
    assert 0 < report["length_share_good"] < 1


def test_share_of_edges_longer_than_twice_the_size_asked_for():
    volume = models.box(1.0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.3)
    gmsh.model.mesh.generate(3)
    field = meshgrow.SizeField()
    field.add_fixed([models.faces_of(volume[1])[0]], [volume], 0.05, 1.5, 0.3)
    lengths = relative_lengths(volume, corner_tags(volume, "Tetrahedron"), TET_EDGES, field)
    report = meshgrow.report(3, [volume], field)
    assert 0.05 < np.mean(lengths > 2) < 0.95
    assert report["length_share_over_2"] == pytest.approx(np.mean(lengths > 2), rel=1e-9)


def test_qualities_of_tetrahedra(meshed_box):
    volume, _, _ = meshed_box
    a, b, c, d = np.moveaxis(corners(volume, "Tetrahedron"), 1, 0)
    volumes = signed_volumes(volume)
    area = sum(np.linalg.norm(np.cross(q - p, r - p), axis=1) / 2
               for p, q, r in ((a, b, c), (a, b, d), (a, c, d), (b, c, d)))
    # The circumscribed centre is as far from a as from the others.
    matrix = 2 * np.stack((b - a, c - a, d - a), axis=1)
    right = np.stack([((p - a)**2).sum(axis=1) for p in (b, c, d)], axis=1)
    radius = np.linalg.norm(np.linalg.solve(matrix, right[..., None])[..., 0], axis=1)
    gamma = 3 * (3 * volumes / area) / radius
    report = meshgrow.report(3, [volume])
    assert report["gamma_min"] == pytest.approx(gamma.min(), rel=1e-9)
    assert report["gamma_mean"] == pytest.approx(gamma.mean(), rel=1e-9)


@pytest.mark.skipif(not hasattr(gmsh.model.mesh, "getElementQualities"),
                    reason="this Gmsh has no getElementQualities")
@pytest.mark.parametrize("dim", [2, 3])
def test_qualities_are_those_of_gmsh(meshed_box, dim):
    volume, face, _ = meshed_box
    entity = face if dim == 2 else volume
    _, tags, _ = gmsh.model.mesh.getElements(*entity)
    report = meshgrow.report(dim, [entity])
    for name, key in (("gamma", "gamma"), ("minSICN", "sicn")):
        values = np.asarray(gmsh.model.mesh.getElementQualities(tags[0], name))
        assert report[key + "_min"] == pytest.approx(values.min(), rel=1e-6)
        assert report[key + "_mean"] == pytest.approx(values.mean(), rel=1e-6)


def test_report_without_entities_is_of_the_whole_dimension():
    model = models.two_boxes()
    premesh([model.left, model.right], 0.4)
    by_volume = [meshgrow.report(3, [v])["elements"] for v in (model.left, model.right)]
    assert min(by_volume) > 0
    assert meshgrow.report(3)["elements"] == sum(by_volume)


def test_elements_of_second_order_are_measured_by_their_corners(meshed_box):
    volume, _, _ = meshed_box
    before = meshgrow.report(3, [volume])
    gmsh.model.mesh.setOrder(2)
    after = meshgrow.report(3, [volume])
    for key, value in before.items():
        assert after[key] == (None if value is None else pytest.approx(value, rel=1e-12)), key


def test_what_is_not_measured_is_none(meshed_box):
    assert meshgrow.report(3)["length_median"] is None
    assert meshgrow.report(3)["ratio_max"] is not None


def test_report_of_a_model_without_a_mesh_has_nothing_but_a_count():
    models.box(1.0)
    report = meshgrow.report(3)
    assert report.pop("elements") == 0
    assert set(report.values()) == {None}


def discrete_volume(element_type, points):
    models.start("discrete volume")
    gmsh.model.addDiscreteEntity(3, 1)
    points = np.asarray(points, dtype=float)
    tags = list(range(1, len(points) + 1))
    gmsh.model.mesh.addNodes(3, 1, tags, points.ravel())
    gmsh.model.mesh.addElementsByType(1, element_type, [], tags)
    return (3, 1)


CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]


@pytest.mark.parametrize("kind, points, size", [
    (5, CUBE, 1.0),
    (6, [CUBE[i] for i in (0, 1, 3, 4, 5, 7)], (7 + 2 * np.sqrt(2)) / 9),
    (7, CUBE[:4] + [(0.5, 0.5, np.sqrt(0.5))], 1.0),
], ids=["hexahedron", "prism", "pyramid"])
def test_elements_that_are_no_simplices_are_measured(kind, points, size):
    volume = discrete_volume(kind, points)
    report = meshgrow.report(3, [volume])
    assert report["elements"] == 1
    assert report["smallest_size"] == pytest.approx(size, rel=1e-12)
    assert report["gamma_min"] is None


TRIHEDRON = 140


def test_an_element_type_that_is_not_read_is_named():
    try:
        discrete_volume(TRIHEDRON, CUBE[:4])
    except Exception as error:  # ValueError or Exception, by version
        pytest.skip("this Gmsh adds no trihedra: %s" % error)
    assert list(gmsh.model.mesh.getElementTypes(3, 1)) == [TRIHEDRON]
    with pytest.raises(meshgrow.Error) as caught:
        meshgrow.report(3)
    sentence = str(caught.value)
    assert "Volume 1" in sentence
    assert "140" in sentence or "trihedr" in sentence.lower()


# ==== The table ====



def test_table_lines_up_and_shows_what_is_unknown_as_a_dash(meshed_box):
    volume, _, field = meshed_box
    with_field = meshgrow.report(3, [volume], field)
    alone = meshgrow.report(3, [volume])
    table = meshgrow.report_table({"with the field": with_field, "größe": alone})
    lines = table.rstrip("\n").split("\n")
    assert len(lines) == 3
    assert len({len(line) for line in lines}) == 1
    assert lines[1].startswith("with the field")
    assert lines[2].startswith("größe")
    assert "-" not in lines[1].split()
    assert lines[2].split().count("-") == 3
    # Right-aligned columns: under the last letter of each number stands the last letter of a dash.
    assert lines[1].rstrip() == lines[1] and lines[2].rstrip() == lines[2]
    assert "%.2f" % alone["ratio_max"] in lines[1] and "%.2f" % alone["ratio_max"] in lines[2]


def test_table_of_no_reports_is_its_head_alone():
    assert len(meshgrow.report_table({}).rstrip("\n").split("\n")) == 1


def test_table_counts_elements_in_groups_of_three_digits():
    report = dict.fromkeys(["smallest_size", "largest_size", "ratio_max", "ratio_99",
                            "length_median", "length_share_good", "length_share_over_2",
                            "gamma_min", "gamma_mean", "sicn_min", "sicn_mean"])
    report["elements"] = 1234567
    assert "1,234,567" in meshgrow.report_table({"large": report})


def test_a_table_of_something_else_is_refused():
    with pytest.raises(meshgrow.Error):
        meshgrow.report_table({"nothing": {}})
