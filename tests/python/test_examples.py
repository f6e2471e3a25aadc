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
