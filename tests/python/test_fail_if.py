"""Conditions that a mesh must not meet, for continuous integration: `--fail-if` and `--report`."""

import json
import re

import gmsh
import numpy as np
import pytest

from program import run

KEYS = ["elements", "smallest_size", "largest_size", "ratio_max", "ratio_p99", "length_median",
        "length_share_good", "length_share_over_2", "gamma_min", "gamma_mean", "sicn_min",
        "sicn_mean"]
BOX = 'SetFactory("OpenCASCADE");\nBox(1) = {0, 0, 0, 1, 1, 1};\nMesh.MeshSizeMax = 0.3;\n'
FIXED = "fixed source Surface{1} attach Volume{1} size 0.05 growth 1.5 limit 0.5"


@pytest.fixture
def box(tmp_path):
    path = tmp_path / "box.geo"
    path.write_text(BOX)
    return path


def conditions(*texts):
    return [argument for text in texts for argument in ("--fail-if", text)]


def test_a_mesh_that_meets_no_condition_is_done(box, tmp_path):
    report = tmp_path / "report.json"
    result = run("mesh", box, "-3", "--report", report, "--size-function", FIXED,
                 *conditions("ratio_p99 > 5", "gamma_min<=0.01", "elements < 10"))
    assert result.returncode == 0, result.stderr
    row, = json.loads(report.read_text())
    assert row["name"] == "box.msh" and row["failed"] == []
    assert row["report"]["ratio_99"] < 5 and row["report"]["elements"] > 10


def test_the_worst_places_are_told_and_are_those_of_the_file(box, tmp_path):
    report = tmp_path / "report.json"
    out = tmp_path / "out.msh"
    result = run("mesh", box, "-3", "-o", out, "--report", report,
                 *conditions("ratio_p99 > 1.01", "gamma_min < 0.9", "largest_size > 0.1"))
    assert result.returncode == 1
    assert out.exists()
    failed = json.loads(report.read_text())[0]["failed"]
    assert [f["condition"] for f in failed] == ["ratio_p99 > 1.01", "gamma_min < 0.9",
                                                "largest_size > 0.1"]
    assert all(len(f["places"]) == 10 for f in failed)
    for f in failed:
        assert "'%s' holds" % f["condition"] in result.stderr
    told = re.findall(r"elements (\d+) and (\d+) of Volume 1 at", result.stderr)
    assert [[int(a), int(b)] for a, b in told] == [p["elements"] for p in failed[0]["places"]]

    gmsh.open(str(out))
    numbers, points, _ = gmsh.model.mesh.getNodes()
    at = dict(zip(numbers, points.reshape(-1, 3)))

    def corners(element):
        return [at[n] for n in gmsh.model.mesh.getElement(element)[1][:4]]

    def size(element):
        c = corners(element)
        return np.mean([np.linalg.norm(c[i] - c[j]) for i in range(4) for j in range(i)])

    all_tetrahedra = gmsh.model.mesh.getElementsByType(4)[0]
    sizes = [size(e) for e in all_tetrahedra]
    for place in failed[0]["places"]:
        a, b = map(size, place["elements"])
        assert max(a, b) / min(a, b) == pytest.approx(place["value"], rel=1e-9)
        middle = np.mean([np.mean(corners(e), axis=0) for e in place["elements"]], axis=0)
        assert middle == pytest.approx(place["point"], abs=1e-9)
    values = [p["value"] for p in failed[2]["places"]]
    assert values == pytest.approx(sorted(sizes, reverse=True)[:10], rel=1e-9)
    assert [p["value"] for p in failed[1]["places"]] == sorted(
        p["value"] for p in failed[1]["places"])


def test_lengths_are_compared_with_the_sizes_asked_for(box):
    result = run("mesh", box, "-3", "--size-function", FIXED,
                 *conditions("length_share_good < 1", "length_median > 0.1",
                             "length_share_over_2 >= 0"))
    assert result.returncode == 1
    assert len(re.findall("holds", result.stderr)) == 3
    assert len(re.findall("element [0-9]+ of Volume 1 at", result.stderr)) == 30


def test_what_is_unknown_fails_with_its_reason(box, tmp_path):
    result = run("mesh", box, "-3", *conditions("length_median > 100"))
    assert result.returncode == 1
    assert "length_median is unknown, since no size function is given" in result.stderr
    result = run("mesh", box, "-1", "--report", tmp_path / "r.json", *conditions("gamma_min < 0"))
    assert result.returncode == 1
    assert "gamma_min is unknown, since there are no elements" in result.stderr
    assert json.loads((tmp_path / "r.json").read_text())[0]["failed"][0]["value"] is None


@pytest.mark.parametrize("text, words", [
    ("ratio_p98 > 1.4", ["ratio_p98", *KEYS]),
    ("ratio_p99 = 1.4", ["ratio_p99 = 1.4", "> >= < <="]),
    ("ratio_p99 > big", ["such as"]),
    ("ratio_p99 > 1.4 or so", ["such as"]),
    ("> 1.4", ["such as"]),
    ("", ["such as"]),
    ("ratio_p99 <", ["such as"]),
])
@pytest.mark.parametrize("command", ["mesh", "report"])
def test_a_wrong_condition_is_refused_before_the_work(box, tmp_path, command, text, words):
    result = run(command, box, "--fail-if", text)
    assert result.returncode == 2
    lines = result.stderr.splitlines()
    assert len(lines) == 1 and all(word in lines[0] for word in words), result.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["box.geo"] and result.stdout == ""


def test_report_command_checks_every_mesh(box, tmp_path):
    coarse, fine = tmp_path / "coarse.msh", tmp_path / "fine.msh"
    assert run("mesh", box, "-3", "-o", coarse).returncode == 0
    assert run("mesh", box, "-3", "-o", fine, "-clscale", 0.5).returncode == 0
    result = run("report", coarse, fine, "--json", *conditions("largest_size > 0.25"))
    assert result.returncode == 1
    assert "coarse.msh: largest_size is" in result.stderr and "fine.msh" not in result.stderr
    rows = json.loads(result.stdout)
    assert len(rows[0]["failed"]) == 1 and rows[1]["failed"] == []


def test_the_report_is_written_whole_or_not_at_all(box, tmp_path):
    report = tmp_path / "report.json"
    report.write_text("of before")
    assert run("mesh", box, "-3", "--report", report, "--size-function",
               "mesh source Surface{1} attach Volume{1} growth 1.2 limit 1", "-1",
               "--strict").returncode == 1
    assert report.read_text() == "of before"
    assert run("mesh", box, "-3", "--report", tmp_path / "missing" / "r.json").returncode == 2
    assert run("mesh", box, "-3", "--report", report).returncode == 0
    assert json.loads(report.read_text())[0]["report"]["elements"] > 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["box.geo", "box.msh", "report.json"]
