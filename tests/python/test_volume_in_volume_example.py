"""A volume in a volume, meshed one after the other in either order, and the same by the .geo."""

import json
import os

import pytest

import program
from example_fixture import EXAMPLES, example  # noqa: F401
from meshes_of_examples import elements_by_entity


def test_either_order_of_the_volumes_jumps_without_a_mesh_size_function_and_not_with(
        example, tmp_path):
    module = example("volume_in_volume")
    rows = module.main()
    for model in module.MODELS:
        for order in module.ORDERS:
            old, new = (rows[model, variant, order] for variant in ("old", "new"))
            before, after = old["volume.2"], new["volume.2"]
            assert old["jump"] > 1.55 and new["jump"] <= 1.28
            assert before["ratio_99"] > after["ratio_99"] + 0.1
            assert before["length_share_over_2"] > 0.28
            assert after["ratio_99"] <= 1.3
            assert after["length_share_over_2"] <= 0.02
            assert new["volume.1"]["ratio_99"] <= 1.38
        case = json.loads(
            (tmp_path / ("volume_in_volume.%s.case.json" % model.replace(" ", "_"))).read_text())
        lines = {variant["name"]: len(variant["lines"]) for variant in case["variants"]}
        assert lines == {"old": 4, "crosswise": 4, "new": 5,
                         "old, volume.1 first": 4, "old, volume.2 first": 4,
                         "new, volume.1 first": 5, "new, volume.2 first": 5}


def test_only_the_volume_meshed_first_has_a_mesh_before_the_other_one(example):
    module = example("volume_in_volume")
    gmsh = module.gmsh
    for first in ("outer", "inner"):
        gmsh.model.add(first)
        outer, inner, common = module.build_not_similar()
        volume, other = (outer, inner) if first == "outer" else (inner, outer)
        module.mesh_only(volume, other, module.make_field("old", outer, inner, common))

        def count(entity):
            return sum(map(len, gmsh.model.mesh.getElements(*entity)[1]))

        meshed = {entity for dim in (1, 2, 3) for entity in gmsh.model.getEntities(dim)
                  if count(entity)}
        faces = set(module.tools.surfaces_of([volume]))
        assert {entity for entity in meshed if entity[0] > 1} == faces | {volume}
        assert {entity for entity in meshed if entity[0] == 1} <= set(module.tools.boundary(faces))
        gmsh.model.remove()


@pytest.mark.parametrize("model", ["similar", "not similar"])
def test_the_geo_gives_the_same_elements(example, tmp_path, model):
    module = example("volume_in_volume")
    case = module.cases.Case("volume_in_volume", "geo", model, "", "", "")
    module.tools.start("volume_in_volume")
    module.make_mesh(model, "new", case)
    made = tmp_path / "by_geo.msh"
    result = program.run("mesh", os.path.join(EXAMPLES, "volume_in_volume.geo"), "-3", "-o", made,
                         "--evaluator", "grid", "-setnumber", "coarse", 2,
                         "-setnumber", "not_similar", int(model == "not similar"))
    assert result.returncode == 0, result.stderr
    by_python = tmp_path / case.record["variants"][0]["mesh"]
    assert elements_by_entity(made, 3) == elements_by_entity(by_python, 3)
