"""The sweep on Dask, small: what it returns, and that a crash costs one variant only."""

import importlib.util
import json
import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(importlib.util.find_spec("distributed") is None,
                                reason="tests/setup.sh installs it beside the newest Gmsh")

EXAMPLES = os.path.join(os.path.dirname(__file__), "..", "..", "examples")
RUN = """
import json, sys
sys.path.insert(0, %r)
import sweep_dask
if __name__ == "__main__":
    results = sweep_dask.main(sys.argv[1:])
    print("RESULTS " + json.dumps(results))
"""


def sweep(tmp_path, *arguments):
    """Results and all that it printed."""
    script = tmp_path / "run_sweep.py"
    script.write_text(RUN % os.path.abspath(EXAMPLES))
    path = os.pathsep.join([os.path.abspath(EXAMPLES), os.environ.get("PYTHONPATH", "")])
    environment = dict(os.environ, PYTHONPATH=path, MESHGROW_EXAMPLES_OUT=str(tmp_path),
                       MESHGROW_EXAMPLES_COARSE="4")
    os.makedirs(tmp_path, exist_ok=True)
    child = subprocess.run([sys.executable, str(script), "--workers", "2", *map(str, arguments)],
                           env=environment, cwd=str(tmp_path), stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT, text=True, timeout=600)
    assert child.returncode == 0, child.stdout
    line, = [line for line in child.stdout.splitlines() if line.startswith("RESULTS ")]
    return json.loads(line[8:]), child.stdout


def test_variants_that_share_a_field(tmp_path):
    results, text = sweep(tmp_path, "--variants", 4)
    assert len(results) == 4 and "4 of 4" in text
    assert all(r["elements"] > 100 and r["ratio_99"] < 2 and r["gamma_min"] > 0 and not r["note"]
               for r in results)
    assert results[0]["elements"] > 1.2 * results[2]["elements"], "finer walls"
    assert len(list((tmp_path / "sweep").glob("*.mgf"))) == 2, "a file for two meshers"


def test_a_crash_is_reported_and_costs_no_other_variant(tmp_path):
    results, text = sweep(tmp_path, "--variants", 4, "--crash-variant", 1)
    assert text.count("crashed its worker and is tried once more") == 1
    assert results[1] == {"note": "crashed 2 times"}
    assert all(results[i]["elements"] > 100 and not results[i]["note"] for i in (0, 2, 3))


def test_a_variant_that_crashed_once_is_meshed_by_the_second_try(tmp_path):
    results, _ = sweep(tmp_path, "--variants", 2, "--crash-variant", 0, "--crash-tries", 1)
    assert [r["note"] for r in results] == ["crashed once before", ""]
    assert all(r["elements"] > 100 for r in results)
