"""Loads an example at reduced size, without pictures, with its results in a folder of the test."""

import importlib
import os
import sys

import pytest

EXAMPLES = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", "examples"))


@pytest.fixture
def example(tmp_path, monkeypatch):
    monkeypatch.setenv("MESHGROW_EXAMPLES_OUT", str(tmp_path))
    monkeypatch.setenv("MESHGROW_EXAMPLES_PICTURES", "0")
    monkeypatch.setenv("MESHGROW_EXAMPLES_COARSE", "2")
    monkeypatch.syspath_prepend(EXAMPLES)

    def load(name):
        for module in ("page.cases", "example_tools", name):
            sys.modules.pop(module, None)
        return importlib.import_module(name)

    return load
