"""Size fields as views of Gmsh, and as files that ParaView and any Gmsh read."""

import os
import re
import subprocess
import sys
import xml.etree.ElementTree

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from program import run

SEED = 20


def field_of_two_boxes(tolerance=0.05):
    """Boxes with a function each; the field, the boxes and what each function asks for."""
    boxes = models.two_boxes()
    field = meshgrow.SizeField(tolerance=tolerance)
    corner, end = gmsh.model.getEntitiesInBoundingBox(-.1, -.1, -.1, .1, .1, .1, 0), \
        gmsh.model.getEntitiesInBoundingBox(1.9, .9, .9, 2.1, 1.1, 1.1, 0)
    field.add_fixed(corner, [boxes.left], size=0.05, growth_rate=1.5, size_limit=0.3)
    field.add_fixed(end, [boxes.right], size=0.08, growth_rate=1.5, size_limit=0.25)
    return field, boxes


def left_sizes(points):
    return np.minimum(0.3, 0.05 + np.linalg.norm(points, axis=1) / 3)


def right_sizes(points):
    return np.minimum(0.25, 0.08 + np.linalg.norm(points - [2, 1, 1], axis=1) / 3)


def smallest_sizes(points):
    return np.minimum(left_sizes(points), right_sizes(points))


def points_in(low, high, count=1000):
    return np.random.default_rng(SEED).uniform(low, high, (count, 3))


def probe(view, points):
    """Values of the view at points (gmsh.view.probe returns more since 4.9)."""
    values = [gmsh.view.probe(view, *p) for p in points]
    return np.array([v[0][0] if isinstance(v, tuple) else v[0] for v in values])


def list_data(view):
    """Type, and elements as arrays of nodes (n, nodes, 3) and values (n, nodes)."""
    types, counts, data = gmsh.view.getListData(view)[:3]
    assert len(types) == 1
    nodes = {"SH": 8, "SQ": 4}[types[0]]
    data = np.array(data[0]).reshape(counts[0], 4, nodes)
    return types[0], data[:, :3].transpose(0, 2, 1), data[:, 3]


# ==== Views


def test_cells_show_the_smallest_size_or_that_of_one_entity():
    field, boxes = field_of_two_boxes()
    for entity, expected in [(None, smallest_sizes), (boxes.left, left_sizes),
                             (boxes.right, right_sizes)]:
        kind, nodes, values = list_data(field.add_view("shown", entity=entity))
        assert kind == "SH"
        exact = expected(nodes.reshape(-1, 3))
        assert np.all(values.ravel() <= 1.051 * exact)
        assert np.all(values.ravel() >= 0.9 * exact)
        volume = np.prod(nodes[:, 6] - nodes[:, 0], axis=1).sum()
        assert volume >= (2 if entity is None else 1) - 1e-6


def test_cells_of_a_built_grid_leave_the_field_as_it_is():
    field, boxes = field_of_two_boxes()
    before = field.statistics()
    assert before["groups"][0]["grid"] is None
    field.add_view(entity=boxes.left)
    assert field.statistics()["groups"][0]["grid"] is None


def test_a_view_has_its_name_and_tag():
    field, boxes = field_of_two_boxes()
    tags = [field.add_view(name) for name in ("first", "second")]
    assert list(gmsh.view.getTags()) == tags
    assert gmsh.option.getString("View[%d].Name" % gmsh.view.getIndex(tags[1])) == "second"


@pytest.mark.parametrize("plane, normal, offset", [
    ("x=0.25", [1, 0, 0], 0.25),
    ("z = 1", [0, 0, 1], 1),
    ([(0.5, 0.5, 0.5), (1, 2, 2)], [1, 2, 2], 2.5),
    (None, [0, 0, 1], 0.5),   # y and z sides are equal
])
def test_plane_cuts_the_box_where_asked(plane, normal, offset):
    field, boxes = field_of_two_boxes()
    kind, nodes, values = list_data(field.add_view(kind="plane", plane=plane))
    assert kind == "SQ"
    assert np.allclose(nodes @ np.array(normal), offset)
    assert np.allclose(values.ravel(), smallest_sizes(nodes.reshape(-1, 3)), rtol=1e-9)
    # In the middles of the squares interpolation is good, too.
    middles = nodes.mean(axis=1)
    assert np.allclose(values.mean(axis=1), smallest_sizes(middles), rtol=0.02)
    # They cover the cut: points of it in the box are each in one square.
    sides = np.linalg.norm(nodes[:, 1] - nodes[:, 0], axis=1)
    if plane is None or isinstance(plane, str):
        assert (sides**2).sum() == pytest.approx({"x=0.25": 1}.get(plane, 2), rel=1e-6)


def test_plane_is_finer_with_a_higher_resolution():
    field, boxes = field_of_two_boxes()
    counts = [len(list_data(field.add_view(kind="plane", resolution=r))[1]) for r in (8, 64)]
    assert counts[0] < counts[1]
    assert counts[1] >= 64 * 32


def test_mesh_view_of_an_entity_has_its_own_sizes_at_the_nodes_of_its_elements():
    field, boxes = field_of_two_boxes()
    field.generate(3)
    for entity, expected in [(boxes.left, left_sizes), (boxes.right, right_sizes)]:
        view = field.add_view(kind="mesh", entity=entity)
        kind, tags, values = gmsh.view.getModelData(view, 0)[:3]
        assert kind == "ElementNodeData"
        _, elements, nodes = gmsh.model.mesh.getElements(*entity)
        assert sorted(tags) == sorted(elements[0])
        first = np.array([gmsh.model.mesh.getNode(n)[0] for n in nodes[0][:4]])
        assert np.allclose(values[list(tags).index(elements[0][0])], expected(first))


def test_mesh_view_of_all_has_the_smallest_sizes_at_all_nodes():
    field, boxes = field_of_two_boxes()
    field.generate(2)
    view = field.add_view(kind="mesh")
    kind, tags, values = gmsh.view.getModelData(view, 0)[:3]
    assert kind == "NodeData"
    nodes, coordinates, _ = gmsh.model.mesh.getNodes()
    assert sorted(tags) == sorted(nodes)
    place = dict(zip(nodes, coordinates.reshape(-1, 3)))
    assert np.allclose(np.ravel(values), smallest_sizes(np.array([place[t] for t in tags])))


def test_smallest_size():
    field, boxes = field_of_two_boxes()
    points = points_in([0, 0, 0], [2, 1, 1])
    assert np.allclose(field.smallest_size(points), smallest_sizes(points), rtol=1e-12)


@pytest.mark.parametrize("arguments, words", [
    (dict(kind="sphere"), ["sphere", "cells", "plane", "mesh"]),
    (dict(entity=(3, 77)), ["Volume 77"]),
    (dict(kind="mesh"), ["no mesh"]),
    (dict(kind="mesh", entity=(3, 1)), ["Volume 1", "no mesh"]),
    (dict(kind="plane", plane="x=9"), ["cuts its box"]),
    (dict(kind="plane", plane=[(0, 0, 0), (0, 0, 0)]), ["normal"]),
    (dict(kind="plane", resolution=100000), ["resolution", "100000"]),
])
def test_what_cannot_be_shown_is_told_and_leaves_no_view(arguments, words):
    field, boxes = field_of_two_boxes()
    with pytest.raises(meshgrow.Error) as error:
        field.add_view(**arguments)
    for word in words:
        assert word in str(error.value)
    assert len(gmsh.view.getTags()) == 0


@pytest.mark.parametrize("arguments", [
    dict(plane="w=1"), dict(plane="x=one"), dict(plane=[1, 2, 3]), dict(entity=(4, 1))])
def test_bad_arguments(arguments):
    field, boxes = field_of_two_boxes()
    with pytest.raises(ValueError):
        field.add_view(kind="plane", **arguments)


def test_no_function_no_view(tmp_path):
    models.box()
    field = meshgrow.SizeField()
    with pytest.raises(meshgrow.Error, match="No size function"):
        field.add_view()
    with pytest.raises(meshgrow.Error, match="No size function"):
        field.write_view(tmp_path / "sizes.vtu")
    assert list(tmp_path.iterdir()) == []


# ==== Files


def read_vtu(path):
    """Arrays of a .vtu with appended raw data, by name."""
    content = path.read_bytes()
    start = content.index(b'<AppendedData encoding="raw">')
    data = content[content.index(b"_", start) + 1:content.rindex(b"\n  </AppendedData>")]
    head = content[:start] + b"</VTKFile>"
    root = xml.etree.ElementTree.fromstring(head)
    assert root.get("byte_order") == "LittleEndian" and root.get("header_type") == "UInt64"
    dtypes = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8", "UInt8": "<u1"}
    arrays, end = {}, 0
    for array in root.iter("DataArray"):
        offset = int(array.get("offset"))
        assert offset == end
        size = int(np.frombuffer(data, "<u8", 1, offset)[0])
        end = offset + 8 + size
        arrays[array.get("Name")] = np.frombuffer(data[offset + 8:end], dtypes[array.get("type")])
    assert end == len(data)
    piece = root.find("UnstructuredGrid/Piece")
    return arrays, int(piece.get("NumberOfPoints")), int(piece.get("NumberOfCells"))


def test_vtu_holds_the_cells_with_sizes_depths_and_groups(tmp_path):
    field, boxes = field_of_two_boxes()
    path = tmp_path / "sizes.vtu"
    count = field.write_view(path)
    arrays, point_count, cell_count = read_vtu(path)
    assert cell_count == count > 20
    points = arrays["Points"].reshape(-1, 3)
    assert len(points) == len(arrays["size"]) == point_count
    assert np.allclose(arrays["size"], smallest_sizes(points), rtol=0.1)
    cells = arrays["connectivity"].reshape(-1, 8)
    assert len(cells) == cell_count and cells.max() == point_count - 1
    assert list(arrays["offsets"]) == list(range(8, 8 * cell_count + 1, 8))
    assert set(arrays["types"]) == {12}
    # As hexahedra are numbered: edges of the depth's length.
    edges = points[cells]
    length = 2 / 2.0**arrays["depth"]
    for a, b, axis in [(0, 1, 0), (1, 2, 1), (3, 2, 0), (0, 4, 2), (2, 6, 2), (7, 6, 0)]:
        assert np.allclose((edges[:, b] - edges[:, a])[:, axis], length, rtol=1e-6)
    assert set(arrays["exact"]) <= {0, 1} and 1 in arrays["exact"]
    middles = edges.mean(axis=1)
    left = left_sizes(middles) < right_sizes(middles)
    groups = [g["functions"] for g in field.statistics()["groups"]]
    decided = [groups[g - 1] for g in arrays["group"]]
    assert all((0 in d) if is_left else (1 in d) for d, is_left in zip(decided, left))
    assert left.any() and not left.all()


@pytest.mark.parametrize("tolerance", [0.02, 0.1])
def test_pos_gives_the_sizes_back_within_the_tolerance(tmp_path, tolerance):
    field, boxes = field_of_two_boxes(tolerance)
    path = tmp_path / "sizes.pos"
    field.write_view(path)
    gmsh.merge(str(path))
    points = points_in([0, 0, 0], [2, 1, 1], 10000)
    ratio = probe(gmsh.view.getTags()[-1], points) / smallest_sizes(points)
    assert ratio.max() <= 1 + tolerance, "seed %d" % SEED
    assert np.quantile(ratio, 0.001) >= 1 - 2 * tolerance, "seed %d" % SEED
    assert np.mean(ratio >= 1 - tolerance) > 0.98, "seed %d" % SEED


def test_pos_of_one_entity(tmp_path):
    field, boxes = field_of_two_boxes()
    path = tmp_path / "sizes.pos"
    field.write_view(path, entity=boxes.right)
    gmsh.merge(str(path))
    points = points_in([1, 0, 0], [2, 1, 1])
    assert np.allclose(probe(gmsh.view.getTags()[-1], points), right_sizes(points), rtol=0.1)


def test_msh_gives_the_sizes_back_too(tmp_path):
    field, boxes = field_of_two_boxes()
    path = tmp_path / "sizes.msh"
    count = field.write_view(path)
    gmsh.model.add("sizes")
    gmsh.merge(str(path))
    assert gmsh.model.getEntities() == [(3, 1)]
    assert len(gmsh.model.mesh.getElements(3)[1][0]) == count
    points = points_in([0, 0, 0], [2, 1, 1], 2000)
    ratio = probe(gmsh.view.getTags()[-1], points) / smallest_sizes(points)
    assert 0.9 <= ratio.min() and ratio.max() <= 1.05, "seed %d" % SEED


def test_sizes_grown_from_a_mesh_survive_in_a_pos(tmp_path):
    """Beside the source, where the field answers from facets and the view cannot."""
    model = models.sphere_in_box()
    field = meshgrow.SizeField(evaluator="grid")
    field.add_mesh([model.sphere], [model.outer], growth_rate=1.2, size_limit=1.0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.15)
    gmsh.model.mesh.generate(2)
    path = tmp_path / "sizes.pos"
    field.write_view(path)
    gmsh.merge(str(path))
    directions = np.random.default_rng(SEED).normal(size=(10000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    points = directions * np.linspace(1, 1.5, 10000)[:, None]
    points[5000:] = points_in([-3, -3, -3], [3, 3, 3], 5000)
    exact = field.exact_size(*model.outer, points)
    ratio = probe(gmsh.view.getTags()[-1], points) / exact
    assert ratio.max() <= 1.05, "seed %d" % SEED
    assert np.mean(ratio >= 0.95) > 0.98 and ratio.min() > 0.9, "seed %d" % SEED


@pytest.mark.parametrize("name", ["sizes.stl", "sizes", "missing/sizes.vtu"])
def test_unwritable_files(tmp_path, name):
    field, boxes = field_of_two_boxes()
    with pytest.raises(meshgrow.Error, match=re.escape(name)):
        field.write_view(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_file_stays_as_it_was_if_the_field_cannot_be_written(tmp_path):
    field, boxes = field_of_two_boxes()
    path = tmp_path / "sizes.vtu"
    path.write_text("precious")
    with pytest.raises(meshgrow.Error, match="Volume 9"):
        field.write_view(path, entity=(3, 9))
    assert path.read_text() == "precious"
    assert [p.name for p in tmp_path.iterdir()] == ["sizes.vtu"]


# ==== The program, and stock Gmsh

BOX = """
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
"""
FIXED = "fixed source Point{1} attach Volume{1} size 0.03 growth 1.2 limit 0.1"  # at (0, 0, 1)


def stock_gmsh():
    """The program of the Gmsh that this interpreter imports: a script of its own where that comes
    from PyPI."""
    beside = os.path.join(os.path.dirname(sys.executable), "gmsh")
    with open(beside, "rb") as file:
        is_script = file.read(2) == b"#!"
    return [sys.executable, beside] if is_script else [beside]


@pytest.fixture
def box(tmp_path):
    path = tmp_path / "box.geo"
    path.write_text(BOX)
    return path


def tetrahedra(path):
    gmsh.open(str(path))
    return sum(len(e) for e in gmsh.model.mesh.getElements(3)[1])


@pytest.mark.parametrize("algorithm", [1, 10])
def test_stock_gmsh_meshes_by_the_view_as_by_the_field(box, tmp_path, algorithm):
    pos = tmp_path / "sizes.pos"
    written = run("field", box, "-o", pos, "--size-function", FIXED)
    assert written.returncode == 0, written.stderr
    for line in ('Merge "%s";' % pos, "Field[1] = PostView;", "Background Field = 1;"):
        assert line in written.stdout
    options = "Mesh.Algorithm3D = %d;\nMesh.MeshSizeExtendFromBoundary = 0;\n" % algorithm
    user = tmp_path / "user.geo"
    user.write_text(BOX + options + 'Merge "sizes.pos";\nField[1] = PostView;\n'
                    "Field[1].ViewIndex = 0;\nBackground Field = 1;\n")
    stock = subprocess.run(stock_gmsh() + ["-3", "user.geo", "-o", "stock.msh"], cwd=tmp_path,
                           capture_output=True, text=True)
    assert stock.returncode == 0, stock.stdout + stock.stderr
    direct = tmp_path / "direct.geo"
    direct.write_text(BOX + options)
    meshed = run("mesh", direct, "-3", "-o", tmp_path / "direct.msh", "--size-function", FIXED)
    assert meshed.returncode == 0, meshed.stderr
    counts = [tetrahedra(tmp_path / name) for name in ("stock.msh", "direct.msh")]
    assert counts[1] > 3000
    assert 0.9 < counts[0] / counts[1] < 1.15


def test_program_writes_the_field_of_an_entity_with_its_tolerance(box, tmp_path):
    pos = tmp_path / "sizes.pos"
    assert run("field", box, "-o", pos, "--entity", "3,1", "--tolerance", 0.02,
               "--size-function", FIXED).returncode == 0
    gmsh.merge(str(pos))
    points = points_in([0, 0, 0], [1, 1, 1])
    exact = np.minimum(0.1, 0.03 + np.linalg.norm(points - [0, 0, 1], axis=1) / 6)
    assert np.allclose(probe(gmsh.view.getTags()[-1], points), exact, rtol=0.05)


@pytest.mark.parametrize("extra, words", [
    (["--entity", "3,7"], ["Volume 7"]),
    (["--entity", "three"], ["three", "3,2"]),
    (["--entity", "5,1"], ["5,1"]),
])
def test_program_refuses(box, tmp_path, extra, words):
    result = run("field", box, "-o", tmp_path / "sizes.vtu", "--size-function", FIXED, *extra)
    assert result.returncode == 2
    for word in words:
        assert word in result.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["box.geo"]


def test_program_needs_functions_and_a_known_ending(box, tmp_path):
    result = run("field", box, "-o", tmp_path / "sizes.vtu")
    assert result.returncode == 2 and "--size-function" in result.stderr
    result = run("field", box, "-o", tmp_path / "sizes.stl", "--size-function", FIXED)
    assert result.returncode == 2 and ".vtu" in result.stderr
    before = box.read_text()
    result = run("field", box, "-o", box, "--size-function", FIXED)
    assert result.returncode == 2 and box.read_text() == before


def test_program_meshes_sources_when_told_to(box, tmp_path):
    path = tmp_path / "sizes.vtu"
    grown = "mesh source Surface{1} attach Volume{1} growth 1.2 limit 1"
    result = run("field", box, "-o", path, "--size-function", grown)
    assert result.returncode == 1
    assert "Surface 1 has no mesh" in result.stderr and "-2" in result.stderr
    assert not path.exists()
    assert run("field", box, "-1", "-o", path, "--size-function", grown).returncode == 1
    result = run("field", box, "-2", "-o", path, "--size-function", grown)
    assert result.returncode == 0, result.stderr
    assert read_vtu(path)[2] > 0


def test_flat_models_have_views_too(tmp_path):
    """A view of them has no thickness in Gmsh's mesher, but cells have."""
    square = models.square()
    field = meshgrow.SizeField(tolerance=0.02)
    field.add_fixed([square.left], [square.face], size=0.03, growth_rate=1.2, size_limit=0.1)
    path = tmp_path / "sizes.pos"
    field.write_view(path)
    gmsh.merge(str(path))
    points = points_in([0, 0, 0], [1, 1, 0])
    points[:4, :2] = [[0, 0], [1, 1], [0, 1], [1, 0]]
    expected = np.minimum(0.1, 0.03 + points[:, 0] / 6)
    assert np.allclose(probe(gmsh.view.getTags()[-1], points), expected, rtol=0.05)
    kind, nodes, values = list_data(field.add_view(kind="plane"))
    assert np.allclose(nodes[..., 2], 0)
    kind, nodes, values = list_data(field.add_view(kind="cells", entity=square.face))
    assert len(nodes) > 1


def test_example_of_stock_gmsh(tmp_path):
    examples = os.path.join(os.path.dirname(__file__), "..", "..", "examples")
    with open(os.path.join(examples, "stock_gmsh_view.geo")) as file:
        text = file.read()
    model = tmp_path / "stock_gmsh_view.geo"
    model.write_text(text)
    function = re.search(r"'(curvature .*)'", text).group(1)

    def stock(output):
        result = subprocess.run(stock_gmsh() + ["-3", model.name, "-o", output], cwd=tmp_path,
                                capture_output=True, text=True)
        assert result.returncode == 0, result.stdout + result.stderr
        return tetrahedra(tmp_path / output)

    without = stock("without.msh")
    assert run("mesh", model, "-3", "-o", tmp_path / "direct.msh",
               "--size-function", function).returncode == 0
    assert run("field", model, "-o", tmp_path / "sizes.pos",
               "--size-function", function).returncode == 0
    with_view = stock("with.msh")
    assert with_view > 5 * without
    assert with_view == pytest.approx(tetrahedra(tmp_path / "direct.msh"), rel=0.1)
