"""What decides a size: `field.probe` and `meshgrow probe`."""

import json
import subprocess

import gmsh
import numpy as np
import pytest

import meshgrow

from program import PROGRAM

FIXED = "fixed source Surface{1} attach Volume{1} size 0.1 growth 1.3 limit 0.5"
MESH = "mesh source Surface{2} attach Volume{2} growth 1.25 limit 0.6"
BOXES = """
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 1, 1, 1};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Mesh.MeshSizeMax = 0.25;
"""


@pytest.fixture
def boxes(tmp_path):
    path = tmp_path / "boxes.geo"
    path.write_text(BOXES)
    gmsh.open(str(path))
    return path


def run(*arguments):
    return subprocess.run([PROGRAM, "probe", *map(str, arguments)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=120)


def element_corners(tag):
    nodes = gmsh.model.mesh.getElement(tag)[1]
    return sorted(tuple(gmsh.model.mesh.getNode(node)[0]) for node in nodes)


def test_the_element_named_is_the_one_that_the_size_grows_from(boxes):
    gmsh.model.mesh.generate(2)
    field = meshgrow.SizeField()
    field.add(FIXED)
    field.add(MESH)
    triangles = {tag: np.array(element_corners(tag))
                 for tag in gmsh.model.mesh.getElements(2, 2)[1][0]}
    rng = np.random.default_rng(3)
    rules = set()
    for point in rng.uniform((1, 0, 0), (2, 1, 1), (60, 3)):
        found = field.probe(3, 2, point)
        assert found["entity"] == (3, 2) and found["point"] == list(point)
        assert found["size"] == found["exact_size"] == field.exact_size(3, 2, point)[0]
        assert found["interpolated_size"] is None
        assert found["function"]["index"] == 1 and found["function"]["kind"] == "mesh"
        assert found["function"]["text"] == MESH
        rules.add(found["rule"])
        if found["rule"] == "limit":
            assert found["size"] == 0.6 and found["facet"] is None
            continue
        facet = found["facet"]
        assert facet["entity"] == (2, 2)
        corners = triangles[facet["element"]]
        np.testing.assert_array_equal(sorted(map(tuple, facet["corners"])), corners)
        sides = [np.linalg.norm(corners[i] - corners[i - 1]) for i in range(3)]
        assert facet["start_size"] == pytest.approx(np.mean(sides))
        assert facet["slope"] == pytest.approx(1 - 1 / 1.25)
        assert facet["growth_rate"] == 1.25
        assert found["size"] == pytest.approx(
            facet["start_size"] + facet["slope"] * facet["distance"])
        # No triangle of that face asks for less, by its nearest corner (which is no nearer).
        least = min(np.mean([np.linalg.norm(t[i] - t[i - 1]) for i in range(3)])
                    + facet["slope"] * np.linalg.norm(t - point, axis=1).min()
                    for t in triangles.values())
        assert found["size"] <= least + 1e-12
    assert "facet" in rules


def test_grid_and_exact_sizes_beside_each_other(boxes):
    gmsh.model.mesh.generate(2)
    field = meshgrow.SizeField(evaluator="grid")
    field.add(MESH)
    found = [field.probe(3, 2, p) for p in np.random.default_rng(4).uniform(1, 2, (50, 3))
             * (1, 0.5, 0.5)]
    assert all(f["size"] == f["interpolated_size"] <= 1.05 * f["exact_size"] for f in found)
    assert any(f["size"] != f["exact_size"] for f in found)


def test_where_no_function_acts_and_bad_input(boxes):
    field = meshgrow.SizeField()
    field.add(FIXED)
    found = field.probe(3, 2, (1.5, 0.5, 0.5))
    assert found["rule"] == "nothing" and found["size"] is None
    assert found["function"] is None and found["facet"] is None
    with pytest.raises(meshgrow.Error, match="Volume 9 is not in the model"):
        field.probe(3, 9, (0, 0, 0))
    with pytest.raises(meshgrow.Error, match="not finite"):
        field.probe(3, 1, (0, np.nan, 0))
    with pytest.raises(ValueError, match="one point"):
        field.probe(3, 1, [(0, 0, 0), (1, 1, 1)])
    with pytest.raises(ValueError):
        field.probe(3, 1, (0, 0))


def test_all_kinds_name_the_entity(boxes):
    """Sizes from curvature and gaps, whose facets are of no mesh."""
    field = meshgrow.SizeField()
    field.add_proximity([(3, 1)], [(3, 1)], cells_per_gap=4, size_limit=1.0)
    near = {(2, 1): (0.001, 0.5, 0.5), (2, 2): (0.999, 0.5, 0.5)}
    faces = {face: field.probe(3, 1, point)["facet"] for face, point in near.items()}
    for face, facet in faces.items():
        assert facet["element"] is None
        bounds = gmsh.model.getBoundingBox(*facet["entity"])
        for corner in facet["corners"]:
            assert all(low - 1e-6 <= x <= high + 1e-6
                       for low, x, high in zip(bounds[:3], corner, bounds[3:]))


def test_program_meshes_what_is_needed_and_tells_in_words(boxes):
    result = run(boxes, "-2", "--at", "1.5,0.5,0.5", "--entity", "3,2", "--size-function", MESH,
                 "--size-function", FIXED)
    assert result.returncode == 0, result.stderr
    assert result.stdout.startswith("1.5, 0.5, 0.5 on Volume 2: size 0.")
    assert " of Surface 2 by Mesh size function 1: " in result.stdout
    assert MESH in result.stdout
    assert "Meshing" not in result.stdout


def test_program_gives_json_for_several_points(boxes):
    result = run(boxes, "--at", "0.001,0.5,0.5", "--at", "0.999,0.5,0.5", "--json",
                 "--size-function", FIXED.replace("limit 0.5", "limit 0.2"))
    assert result.returncode == 0, result.stderr
    first, second = json.loads(result.stdout)
    assert first["rule"] == "facet" and first["facet"]["entity"] == [2, 1]
    assert first["size"] == pytest.approx(0.1 + (1 - 1 / 1.3) * 0.001)
    assert second["rule"] == "limit" and second["size"] == 0.2
    assert first["entity"] == [3, 1], "without --entity, one where the function acts"


@pytest.mark.parametrize("arguments, words", [
    (["--at", "1,2", "--size-function", FIXED], "'1,2' is no point"),
    (["--at", "1,2,x", "--size-function", FIXED], "'1,2,x' is no point"),
    (["--at", "1,2,3,4", "--size-function", FIXED], "is no point"),
    (["--at", "1,2,inf", "--size-function", FIXED], "is no point"),
    (["--at", "0,0,0", "--entity", "3,9", "--size-function", FIXED], "Volume 9"),
    (["--at", "0,0,0", "--entity", "3", "--size-function", FIXED], "'3' is no entity"),
    (["--at", "0,0,0"], "No size function is given"),
    (["--at", "0,0,0", "--size-function", MESH], "mesh the sources first"),
])
def test_program_tells_what_is_wrong(boxes, arguments, words):
    result = run(boxes, *arguments)
    assert result.returncode == 2
    assert words in [line for line in result.stderr.splitlines()
                     if line.startswith("meshgrow: ")][0]


def test_program_warns_of_a_source_without_a_mesh(boxes):
    result = run(boxes, "--at", "0,0,0", "--size-function", MESH, "--size-function", FIXED)
    assert result.returncode == 0, result.stderr
    assert "Surface 2 has no mesh" in result.stderr
    assert "Fixed size function 2" in result.stdout
