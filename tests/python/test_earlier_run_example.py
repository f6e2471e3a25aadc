"""A later run: the surface of an earlier one, to the bit, and another mesh in the volume."""

import os
import subprocess

import pytest

import program
from example_fixture import EXAMPLES, example  # noqa: F401
from meshes_of_examples import built_example, elements_by_entity


def volume_elements(path):
    return sum(elements_by_entity(path, 3).values())


@pytest.fixture
def rows(example):
    return example("earlier_run").main()


def test_the_surface_stays_and_the_volume_is_coarser_or_finer(rows, tmp_path):
    assert all(row["same_surface"] for row in rows.values())
    coarser, finer = rows["coarser"]["volume"], rows["finer"]["volume"]
    assert finer["elements"] > 1.5 * coarser["elements"]
    assert finer["ratio_99"] < coarser["ratio_99"]
    assert finer["ratio_99"] <= 1.3 and coarser["ratio_99"] <= 1.4
    for row in (coarser, finer):
        assert row["length_share_over_2"] <= 0.02
    assert (tmp_path / "earlier_run.part.case.json").exists()


def test_the_geo_gives_the_same_mesh(rows, tmp_path):
    geo = tmp_path / "earlier_run.geo"
    with open(os.path.join(EXAMPLES, "earlier_run.geo"), encoding="utf-8") as file:
        geo.write_text(file.read())
    done = program.run("mesh", geo, "-3", "--remesh", "-o", tmp_path / "geo.msh")
    assert done.returncode == 0, done.stderr
    assert volume_elements(tmp_path / "geo.msh") == rows["coarser"]["volume"]["elements"]
    assert elements_by_entity(tmp_path / "geo.msh", 2) == elements_by_entity(
        rows["coarser"]["path"], 2)


def test_the_cpp_program_gives_the_same_mesh(rows, tmp_path):
    subprocess.run([built_example("earlier_run"), str(tmp_path / "cpp.msh")], check=True,
                   stdout=subprocess.DEVNULL)
    assert volume_elements(tmp_path / "cpp.msh") == rows["coarser"]["volume"]["elements"]
