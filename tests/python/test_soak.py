"""Random models, as tests/soak.sh meshes many of: a few of them for every run of the tests."""

import os
import sys

import pytest

sys.path.insert(1, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "soak"))

import batches  # noqa: E402
import summary  # noqa: E402

SEEDS = range(1, 26)


@pytest.fixture(scope="module")
def results():
    return [batches.without_the_library(r) if batches.failed_in_the_library(r) else r
            for r in batches.run(SEEDS)]


def test_random_models_are_meshed_and_all_that_was_there_is_kept(results):
    assert [r["seed"] for r in results] == list(SEEDS)
    assert not summary.broken_promises(results), summary.summary(results)
    assert sum(r["status"] == "meshed" for r in results) >= 23, summary.summary(results)
    assert sum(r.get("premeshed", 0) > 0 for r in results) >= 15


def test_sizes_of_random_models_grow_smoothly_unless_their_sources_jump(results):
    volumes = summary.judged(results)
    assert len(volumes) >= 15
    unexplained = [(r["seed"], v["volume"]) for r, v in volumes
                   if summary.is_steep(v) and summary.cause(v, r["words"]) == summary.NONE_FOUND]
    assert not unexplained, summary.summary(results)
