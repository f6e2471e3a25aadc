"""The examples at reduced size, with the numbers that they are there to show."""

import importlib
import os
import sys

import pytest

EXAMPLES = os.path.join(os.path.dirname(__file__), "..", "..", "examples")


@pytest.fixture
def example(tmp_path, monkeypatch):
    monkeypatch.setenv("MESHGROW_EXAMPLES_OUT", str(tmp_path))
    monkeypatch.setenv("MESHGROW_EXAMPLES_PICTURES", "0")
    monkeypatch.setenv("MESHGROW_EXAMPLES_COARSE", "2")
    monkeypatch.syspath_prepend(EXAMPLES)

    def load(name):
        for module in ("example_tools", name):
            sys.modules.pop(module, None)
        return importlib.import_module(name)

    return load


def test_figure8_grows_smoothly_on_both_sides_of_the_common_faces(example, tmp_path):
    rows = example("figure8").main()
    for volume in ("outer", "inner"):
        assert rows[volume + ", with"]["ratio_99"] <= 1.32
    assert rows["outer, with"]["length_share_over_2"] <= 0.01
    assert rows["outer, without"]["length_share_over_2"] > 0.1
    assert rows["outer, no extension"]["ratio_99"] > rows["outer, with"]["ratio_99"] + 0.2
    assert (tmp_path / "figure8_with.msh").exists()


def test_plates_of_the_assembly_grow_from_the_bolts(example, tmp_path):
    rows = example("assembly").main()
    assert rows["plates, with"]["ratio_99"] <= 1.4
    assert rows["plates, with"]["ratio_99"] < rows["plates, without"]["ratio_99"] - 0.1
    assert rows["plates, with"]["length_share_over_2"] <= 0.01
    assert (tmp_path / "assembly_with.msh").exists()


def test_right_face_fits_the_adjusted_mesh_of_the_common_edge(example, tmp_path):
    module = example("two_faces")
    rows = module.main()
    for source in module.SOURCES:
        for right_face in module.RIGHT_FACES:
            by_gmsh, grown = (rows[source, right_face, name] for name in ("without", "with"))
            assert grown["across_max"] <= 1.3
            assert by_gmsh["across_max"] > grown["across_max"] + 0.1
            assert grown["across_mean"] <= 1.15
    assert (tmp_path / "two_faces_vertex_quads_with.msh").exists()


def test_no_size_jump_behind_the_common_faces_whichever_volume_rules(example, tmp_path):
    module = example("common_face")
    rows = module.main()
    for model in module.MODELS:
        for ruler, other in module.OTHER.items():
            own, grown = (rows[model, ruler, name][other] for name in ("own", "meshgrow"))
            assert grown["ratio_99"] <= 1.32
            assert grown["length_share_over_2"] <= 0.02
            assert own["ratio_99"] > grown["ratio_99"] + 0.05
            assert own["length_share_over_2"] > 0.1
            # What the volume that rules is like does not depend on the other.
            ruling = rows[model, ruler, "meshgrow"][ruler]
            assert ruling["ratio_99"] <= 1.4
            assert ruling["length_share_over_2"] <= 0.02
    assert (tmp_path / "common_face_similar_outer_meshgrow.msh").exists()
