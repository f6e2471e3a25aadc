"""The crack in a block: the volume grows from an embedded surface, which stays as it is."""

import os
import subprocess

import program
from example_fixture import EXAMPLES, example  # noqa: F401
from meshes_of_examples import built_example, elements_by_entity


def test_a_block_grows_from_the_crack_embedded_in_it(example, tmp_path):
    rows = example("crack").main()
    before, grown = rows["without"]["block"], rows["with"]["block"]
    assert grown["ratio_99"] <= 1.3
    assert before["ratio_99"] > grown["ratio_99"] + 0.1
    assert grown["length_share_over_2"] <= 0.01
    assert before["length_share_over_2"] > 0.4
    assert (tmp_path / "crack.block.case.json").exists()


def test_the_crack_keeps_its_mesh_to_the_bit(example):
    for row in example("crack").main().values():
        places, elements = row["premesh"]
        assert len(places) > 100 and elements
        assert row["crack"] == row["premesh"]


def test_crack_geo_gives_the_mesh_of_crack_py(example, tmp_path):
    block = example("crack").main()["with"]["block"]
    done = program.run("mesh", os.path.join(EXAMPLES, "crack.geo"), "-3", "-o",
                       tmp_path / "geo.msh", "-setnumber", "coarse", "2")
    assert done.returncode == 0, done.stderr
    assert sum(elements_by_entity(tmp_path / "geo.msh", 3).values()) == block["elements"]


def test_crack_cpp_gives_the_mesh_of_crack_py(example, tmp_path):
    built = built_example("crack")
    block = example("crack").main()["with"]["block"]
    subprocess.run([built, str(tmp_path / "cpp.msh")], check=True, stdout=subprocess.DEVNULL)
    assert sum(elements_by_entity(tmp_path / "cpp.msh", 3).values()) == block["elements"]
