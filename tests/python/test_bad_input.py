"""What is wrong is told in one sentence, and the model is as it was."""

import math
import re

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from meshes import Log, element_count, has_elements, options, premesh, snapshots

NOT_FINITE = [float("nan"), float("inf"), float("-inf")]


@pytest.fixture
def model():
    """Two boxes, the face between them meshed."""
    made = models.two_boxes()
    premesh([made.between], 0.3)
    return made


def state():
    entities = gmsh.model.getEntities()
    return (entities, snapshots(entities), gmsh.model.getCurrent(), sorted(gmsh.model.list()),
            {e: gmsh.model.getVisibility(*e) for e in entities})


def refused(call, *names):
    """The error of a call that must fail: one sentence with these names, nothing changed."""
    before = state()
    with pytest.raises(meshgrow.Error) as caught:
        call()
    sentence = str(caught.value)
    assert_one_sentence(sentence)
    for name in names:
        assert name in sentence
    assert state() == before
    return sentence


def assert_one_sentence(text):
    assert text.endswith("."), text
    assert "\n" not in text
    assert ". " not in text, text
    assert text[0].isupper() or text[0] == '"', text


def usable(model):
    return dict(sources=[model.between], attach=[model.right], growth_rate=1.2, size_limit=1.0)


# ==== Parameters ====


@pytest.mark.parametrize("growth_rate", [0.999, 0.0, -1.2] + NOT_FINITE)
def test_growth_rate_below_one_is_refused(model, growth_rate):
    field = meshgrow.SizeField()
    refused(lambda: field.add_mesh(**dict(usable(model), growth_rate=growth_rate)), "growth rate")
    assert field.statistics()["functions"] == []


@pytest.mark.parametrize("size_limit", [0.0, -1.0] + NOT_FINITE)
def test_size_limit_that_is_no_length_is_refused(model, size_limit):
    field = meshgrow.SizeField()
    refused(lambda: field.add_mesh(**dict(usable(model), size_limit=size_limit)), "size limit")
    assert field.statistics()["functions"] == []


@pytest.mark.parametrize("size", [0.0, -0.1] + NOT_FINITE)
def test_fixed_size_that_is_no_length_is_refused(model, size):
    field = meshgrow.SizeField()
    refused(lambda: field.add_fixed(size=size, **usable(model)), "the size is")
    assert field.statistics()["functions"] == []


def test_a_missing_size_limit_is_refused(model):
    field = meshgrow.SizeField()
    with pytest.raises(ValueError, match="size_limit"):
        field.add_mesh([model.between], [model.right])
    with pytest.raises(ValueError, match="size_limit"):
        field.add_fixed([model.between], [model.right], 0.1)


def test_a_wrong_word_for_quad_size_or_evaluator_is_refused(model):
    field = meshgrow.SizeField()
    with pytest.raises(ValueError, match="quad_size"):
        field.add_mesh(quad_size="corners", **usable(model))
    with pytest.raises(ValueError, match="evaluator"):
        meshgrow.SizeField(evaluator="fast")


@pytest.mark.parametrize("tolerance", [0.0, -0.05, 1.5] + NOT_FINITE)
def test_a_tolerance_out_of_range_is_refused(model, tolerance):
    refused(lambda: meshgrow.SizeField(tolerance=tolerance), "tolerance")


@pytest.mark.parametrize("threads", [-1, 1e9] + NOT_FINITE)
def test_a_number_of_threads_out_of_range_is_refused(model, threads):
    refused(lambda: meshgrow.SizeField(threads=threads), "threads")


def test_an_unknown_option_is_named(model):
    field = meshgrow.SizeField()
    refused(lambda: field._set("tolerence", 0.1), '"tolerence"')


@pytest.mark.parametrize("dim", [-1, 0, 4])
def test_a_dimension_that_cannot_be_meshed_is_named(model, dim):
    field = meshgrow.SizeField()
    field.add_mesh(**usable(model))
    refused(lambda: field.generate(dim), str(dim))


def test_points_of_a_wrong_shape_are_refused(model):
    field = meshgrow.SizeField()
    field.add_mesh(**usable(model))
    for points in ([[0.0, 1.0]], [0.0, 1.0], np.zeros((2, 3, 3))):
        with pytest.raises(ValueError, match="shape"):
            field.size(*model.right, points)


# ==== Entities ====


@pytest.mark.parametrize("role", ["sources", "attach"])
@pytest.mark.parametrize("entity, name", [((2, 99), "Surface 99"), ((1, 1234), "Curve 1234"),
                                          ((2, -1), "Surface -1"), ((2, 0), "Surface 0")])
def test_an_unknown_entity_is_named(model, role, entity, name):
    field = meshgrow.SizeField()
    refused(lambda: field.add_mesh(**dict(usable(model), **{role: [entity]})), name)


@pytest.mark.parametrize("role", ["sources", "attach"])
def test_a_dimension_that_does_not_exist_is_refused(model, role):
    field = meshgrow.SizeField()
    for dim in (-1, 4):
        refused(lambda: field.add_mesh(**dict(usable(model), **{role: [(dim, 1)]})))


def test_a_mesh_source_that_is_a_volume_or_a_point_is_refused(model):
    field = meshgrow.SizeField()
    refused(lambda: field.add_mesh(**dict(usable(model), sources=[model.left])),
            "Volume %d" % model.left[1])
    refused(lambda: field.add_mesh(**dict(usable(model), sources=[(0, 1)])), "Point 1")


def test_an_attachment_that_is_a_point_is_refused(model):
    field = meshgrow.SizeField()
    refused(lambda: field.add_mesh(**dict(usable(model), attach=[(0, 1)])), "Point 1")


def test_a_mesh_source_that_is_its_own_attachment_is_refused(model):
    field = meshgrow.SizeField()
    refused(lambda: field.add_mesh(**dict(usable(model), attach=[model.between])),
            "Surface %d" % model.between[1])


@pytest.mark.parametrize("role, name", [("sources", "source"), ("attach", "attachment")])
def test_an_empty_list_of_entities_is_refused(model, role, name):
    field = meshgrow.SizeField()
    refused(lambda: field.add_mesh(**dict(usable(model), **{role: []})), name)


def test_sizes_on_an_unknown_entity_are_refused(model):
    field = meshgrow.SizeField()
    field.add_mesh(**usable(model))
    refused(lambda: field.size(3, 77, [[0, 0, 0]]), "Volume 77")
    refused(lambda: field.exact_size(5, 1, [[0, 0, 0]]))


def test_a_report_on_an_unknown_entity_or_of_curves_is_refused(model):
    refused(lambda: meshgrow.report(3, [(3, 77)]), "Volume 77")
    refused(lambda: meshgrow.report(3, [model.between]), "Surface %d" % model.between[1])
    refused(lambda: meshgrow.report(1), "1")


def test_a_refused_function_leaves_the_others_in_force(model):
    field = meshgrow.SizeField()
    field.add_mesh(**usable(model))
    before = field.size(*model.right, [[1.5, 0.5, 0.5]])
    refused(lambda: field.add_mesh(**dict(usable(model), growth_rate=0.5)))
    assert np.array_equal(field.size(*model.right, [[1.5, 0.5, 0.5]]), before)


# ==== Text ====


@pytest.mark.parametrize("text, expected", [
    ("", "expected"),
    ("mesh", "'source'"),
    ("mash source Surface{1} attach Volume{2} growth 1.2 limit 2", "mash"),
    ("mesh source Surface{1} attach Volume{2} growth 1.2", "'limit'"),
    ("mesh source Surface{1} attach Volume{2} limit 2", "'growth'"),
    ("mesh source Surface{1} growth 1.2 limit 2", "'attach'"),
    ("mesh source Surface{1 attach Volume{2} growth 1.2 limit 2", "position 23"),
    ("mesh source Surface{1} attach Volume{2} growth fast limit 2", "growth rate"),
    ("mesh source Surface{1} attach Volume{2} growth 1.2 limit 2 size 0.1", "position"),
    ("fixed source Surface{1} attach Volume{2} growth 1.2 limit 2", "'size'"),
    ("mesh source Surface{99} attach Volume{2} growth 1.2 limit 2", "Surface 99"),
    ('mesh source Physical Surface{"wing"} attach Volume{2} growth 1.2 limit 2', "wing"),
    ("mesh source Surface{1} attach Volume{2} growth 0.2 limit 2", "growth rate"),
    ("mesh source Surface{1} attach Volume{2} growth nan limit 2", "growth rate"),
    ("mesh source Surface{1} attach Volume{2} growth 1.2 limit -2", "size limit"),
    ("mesh source Volume{1} attach Volume{2} growth 1.2 limit 2", "Volume 1"),
])
def test_text_that_is_no_size_function_is_refused_with_what_was_expected(model, text, expected):
    field = meshgrow.SizeField()
    refused(lambda: field.add(text), expected)
    assert field.statistics()["functions"] == []


def test_text_gives_the_same_function_as_its_arguments(model):
    by_text, by_arguments = meshgrow.SizeField(), meshgrow.SizeField()
    by_text.add("mesh source Surface{%d} attach Volume{%d} growth 1.2 limit 1"
                % (model.between[1], model.right[1]))
    by_arguments.add_mesh(**usable(model))
    assert by_text.statistics()["functions"] == by_arguments.statistics()["functions"]


def test_text_names_physical_groups(model):
    group = gmsh.model.addPhysicalGroup(2, [model.between[1]])
    gmsh.model.setPhysicalName(2, group, "interface")
    field = meshgrow.SizeField()
    field.add('mesh source Physical Surface{"interface"} attach Volume{%d} growth 1.2 limit 1'
              % model.right[1])
    assert field.statistics()["functions"][0]["sources"] == [list(model.between)]


# ==== Sources without a mesh ====


@pytest.fixture
def unmeshed():
    return models.two_boxes()


def source_warnings(log, face):
    return [w for w in log.warnings if "Surface %d has no mesh" % face[1] in w]


def test_a_source_without_a_mesh_is_warned_of_once_when_asked_for_sizes(unmeshed):
    field = meshgrow.SizeField()
    field.add_mesh(**usable(unmeshed))
    with Log() as log:
        for _ in range(3):
            assert field.size(*unmeshed.right, [[1.5, 0.5, 0.5]])[0] == math.inf
    assert len(source_warnings(log, unmeshed.between)) == 1


def test_a_source_that_the_same_run_meshes_in_time_is_not_warned_of_when_registered(unmeshed):
    field = meshgrow.SizeField()
    field.add_mesh(**usable(unmeshed))
    with Log() as log:
        field.register()
        with options(Mesh_MeshSizeMax=0.5):
            gmsh.model.mesh.generate(3)
    assert source_warnings(log, unmeshed.between) == []
    assert has_elements(unmeshed.right)


def test_a_source_that_no_run_meshes_in_time_is_warned_of_once_when_registered(unmeshed):
    field = meshgrow.SizeField()
    other = next(f for f in models.faces_of(unmeshed.right[1]) if f != unmeshed.between)
    field.add_mesh([unmeshed.between], [other], 1.2, 0.5)
    with Log() as log:
        field.register()
        with options(Mesh_MeshSizeMax=0.5):
            gmsh.model.mesh.generate(2)
    assert len(source_warnings(log, unmeshed.between)) == 1


def test_strict_refuses_to_register_while_a_source_has_no_mesh(unmeshed):
    field = meshgrow.SizeField(strict=True)
    field.add_mesh(**usable(unmeshed))
    refused(field.register, "Surface %d" % unmeshed.between[1])
    premesh([unmeshed.between], 0.3)
    field.register()


def test_sources_that_grow_into_each_other_are_refused_in_words():
    model = models.two_boxes()
    left = next(f for f in models.faces_of(model.left[1]) if f != model.between)
    right = next(f for f in models.faces_of(model.right[1]) if f != model.between)
    field = meshgrow.SizeField()
    field.add_mesh([left], [right], 1.2, 0.5)
    field.add_mesh([right], [left], 1.2, 0.5)
    names = {"Surface %d" % left[1], "Surface %d" % right[1]}
    for call in (lambda: field.generate(2), lambda: field.plan(2)):
        with pytest.raises(meshgrow.Error) as refusal:
            call()
        words = str(refusal.value).split("; ")[0]
        found = re.findall(r"(Surface \d+) grows from (Surface \d+) by Mesh size function \d+"
                           r"(?: \(at its Curve \d+\))?, which grows from (Surface \d+)", words)
        assert len(found) == 1 and found[0][0] == found[0][2] and set(found[0]) == names, words
    assert not any(has_elements(e) for e in gmsh.model.getEntities())
    premesh([left], 0.4)
    field.generate(2)
    assert has_elements(right)


def test_strict_lets_generate_mesh_the_sources_itself(unmeshed):
    field = meshgrow.SizeField(strict=True)
    field.add_mesh(**usable(unmeshed))
    with options(Mesh_MeshSizeMax=0.4):
        field.generate(3)
    assert has_elements(unmeshed.right)


def test_a_meshed_source_is_not_warned_of(model):
    field = meshgrow.SizeField()
    field.add_mesh(**usable(model))
    with Log() as log, options(Mesh_MeshSizeMax=0.5):
        field.generate(3)
    assert [w for w in log.warnings if "no mesh" in w] == []


# ==== Models ====


def test_a_field_without_a_model_is_refused():
    refused(meshgrow.SizeField, "no entities")


def test_a_field_of_an_empty_model_is_refused():
    gmsh.model.add("empty")
    refused(meshgrow.SizeField, "no entities")


def test_a_report_of_an_empty_model_is_refused():
    gmsh.model.add("empty")
    refused(lambda: meshgrow.report(3), "no entities")


def test_gmsh_that_is_not_initialized_is_told():
    gmsh.finalize()
    for call in (meshgrow.SizeField, lambda: meshgrow.report(3)):
        with pytest.raises(meshgrow.Error, match=r"gmsh\.initialize\(\)") as caught:
            call()
        assert_one_sentence(str(caught.value))


def test_generate_after_an_entity_was_added_is_refused(model):
    field = meshgrow.SizeField()
    field.add_mesh(**usable(model))
    gmsh.model.occ.addPoint(5, 5, 5)
    gmsh.model.occ.synchronize()
    refused(lambda: field.generate(3), "new field")


def test_generate_after_an_entity_was_removed_is_refused(model):
    field = meshgrow.SizeField()
    field.add_mesh(**usable(model))
    gmsh.model.removeEntities([model.right])
    refused(lambda: field.generate(3), "new field")


@pytest.mark.parametrize("call", ["register", "refresh", "summary"])
def test_a_source_that_was_removed_is_told(model, call):
    field = meshgrow.SizeField()
    field.add_mesh(**usable(model))
    gmsh.model.removeEntities([model.left, model.right])
    gmsh.model.removeEntities([model.between])
    refused(getattr(field, call), "new field")


def test_subdivision_by_gmsh_is_refused(model):
    gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 1)
    field = meshgrow.SizeField()
    field.add_mesh(**usable(model))
    refused(lambda: field.generate(3), "Mesh.SubdivisionAlgorithm")


def test_a_field_without_functions_lets_gmsh_mesh_alone():
    counts = []
    for with_field in (False, True):
        made = models.box(1.0)
        with options(Mesh_MeshSizeMax=0.3):
            meshgrow.SizeField().generate(3) if with_field else gmsh.model.mesh.generate(3)
        counts.append(element_count(made))
    assert counts[0] == pytest.approx(counts[1], rel=0.05)
