"""Models that are cleared, removed, rebuilt or changed while a field is theirs; sessions that end.

Each in a process of its own, since a failure may be a crash."""

import textwrap

import pytest

from child import run_child

HEAD = """
import gc, gmsh, meshgrow
import models
from child import told
from meshes import boundary, element_count, has_elements, premesh


def start():
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)


def field_of(model, size=0.05):
    field = meshgrow.SizeField()
    field.add_fixed([model.bottom], [model.face], size, 1.2, 0.3)
    return field


def elements():
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(2)
    return sum(element_count(e) for e in gmsh.model.getEntities(2))


start()
models.square()
alone = elements()
gmsh.clear()
"""


def run(code):
    return run_child(HEAD + textwrap.dedent(code))


# ==== Cleared, finalized ====


@pytest.mark.parametrize("end", ["gmsh.clear()", "gmsh.finalize(); start()",
                                 "gmsh.model.remove()"])
def test_a_registered_field_that_outlives_its_model_leaves_the_next_one_alone(end):
    lines = run("""
        field = field_of(models.square())
        field.register()
        gmsh.model.mesh.generate(2)
        %s
        gmsh.model.add('other')
        face = gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
        gmsh.model.occ.synchronize()
        print(elements() == alone)
        told(field.generate, 2)
        field.unregister()
        print(elements() == alone)
        """ % end)
    assert lines[0] == "True" and lines[2] == "True"
    assert lines[1].startswith("Error: ") and "square" in lines[1]


def test_a_cleared_model_can_be_made_again_with_a_new_field():
    lines = run("""
        old = field_of(models.square())
        old.register()
        gmsh.model.mesh.generate(2)
        gmsh.clear()
        model = models.square()
        field = field_of(model)
        field.register()
        gmsh.model.mesh.generate(2)
        fine = element_count(model.face)
        field.unregister()
        del old
        gc.collect()
        print(fine > 1.5 * alone, elements() == alone)
        """)
    assert lines == ["True True"]


def test_clear_within_a_run_of_the_field_is_no_crash_of_ours():
    """By the listener of progress, between two passes."""
    lines = run("""
        def progress(line):
            if "pass 2" in line:
                gmsh.clear()
        model = models.square()
        field = meshgrow.SizeField(progress=progress)
        field.add_fixed([model.bottom], [model.face], 0.05, 1.2, 0.3)
        told(field.generate, 2)
        models.square()
        print(elements() == alone)
        """)
    assert lines[0].startswith("Error: ") and lines[1] == "True"


# ==== Two models, two fields ====


TWO_MODELS = """
first = models.square()
gmsh.model.setCurrent("square")
coarse = field_of(first, 0.2)
gmsh.model.add("second")
gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
gmsh.model.occ.synchronize()
fine = field_of(first, 0.04)  # the same tags
"""


def test_of_two_models_each_gets_the_sizes_of_its_own_registered_field():
    """Gmsh 4.8 has one callback for all models: there a sentence refuses the second field."""
    lines = run(TWO_MODELS + """
print(gmsh.GMSH_API_VERSION_MINOR)
coarse.register()  # of the other model, which is not current
try:
    fine.register()
except meshgrow.Error as error:
    print(error)
    coarse.unregister()
    fine.register()
counts = []
for name in ("square", "second"):
    gmsh.model.setCurrent(name)
    gmsh.model.mesh.generate(1)
    counts.append(element_count(first.bottom))
print(*counts)
""")
    if lines[0] == "8":
        assert "square" in lines[1] and "unregister" in lines[1]
    of_first, of_second = map(int, lines[-1].split())
    assert of_second == pytest.approx(25, abs=2)
    assert of_first < 12


def test_a_field_registered_while_another_model_is_current_acts_on_its_own():
    lines = run(TWO_MODELS + """
gmsh.model.setCurrent("square")
fine.register()
gmsh.model.mesh.generate(1)
other = element_count(first.bottom)
gmsh.model.setCurrent("second")
gmsh.model.mesh.generate(1)
print(other, element_count(first.bottom))
""")
    other, own = map(int, lines[0].split())
    assert other < 12 and own == pytest.approx(25, abs=2)


@pytest.mark.parametrize("end", ["second.unregister()", "del second; gc.collect()"])
def test_of_two_fields_of_a_model_the_one_registered_last_acts_and_then_the_other_again(end):
    lines = run("""
        model = models.square()
        first, second = field_of(model, 0.1), field_of(model, 0.04)
        counts = []

        def count():
            gmsh.model.mesh.generate(1)
            counts.append(element_count(model.bottom))

        first.register()
        second.register()
        count()
        %s
        count()
        first.unregister()
        count()
        print(*counts)
        """ % end)
    last, before, none = map(int, lines[0].split())
    assert last == pytest.approx(25, abs=2) and before == pytest.approx(10, abs=1)
    assert none < before


# ==== Changed between definition and meshing ====


@pytest.mark.parametrize("removed", [
    "gmsh.model.occ.remove([volume], recursive=True); gmsh.model.occ.synchronize()",
    "gmsh.model.removeEntities([volume]); gmsh.model.removeEntities([source])"])
def test_a_source_that_was_removed_is_told(removed):
    lines = run("""
        volume = models.box()
        source = models.faces_of(volume[1])[0]
        gmsh.model.occ.addBox(2, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        field = meshgrow.SizeField()
        field.add_fixed([source], [volume], 0.3, 1.2, 0.5)
        %s
        told(field.generate, 3)
        told(field.register)
        told(field.refresh)
        told(field.plan, 3)
        told(field.size, 3, 1, [[0, 0, 0]])
        """ % removed)
    assert len(lines) == 5 and all("make a new field" in line for line in lines)


def test_a_source_removed_while_its_field_is_registered_is_no_crash():
    lines = run("""
        volume = models.box()
        source = models.faces_of(volume[1])[0]
        gmsh.model.occ.addBox(2, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        other = gmsh.model.getEntities(3)[-1]
        premesh([source], 0.3)
        field = meshgrow.SizeField()
        field.add_mesh([source], [volume, other], 1.2, 0.5)
        field.register()
        gmsh.model.occ.remove([volume], recursive=True)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(3)
        print(has_elements(other))
        told(field.generate, 3)
        """)
    assert lines[0] == "True" and "make a new field" in lines[1]


def test_a_source_whose_mesh_was_cleared_is_meshed_by_generate():
    lines = run("""
        model = models.square()
        premesh([model.bottom], 0.05)
        field = meshgrow.SizeField()
        field.add_mesh([model.bottom], [model.face], 1.2, 0.5)
        gmsh.model.mesh.clear()
        field.generate(2)
        print(has_elements(model.bottom), has_elements(model.face))
        """)
    assert lines == ["True True"]


REBUILT = """
model = models.square(%s)
field = field_of(model)
%s
gmsh.model.remove()
model = models.square(%s)
told(%s)
"""


@pytest.mark.parametrize("before, call", [
    ("", "field.generate, 2"), ("", "field.register"), ("", "field.refresh"),
    ("field.refresh()", "field.generate, 2"), ("field.register()", "field.refresh"),
    ("field.generate(2)", "field.generate, 2")])
def test_another_geometry_with_the_same_tags_is_noticed(before, call):
    lines = run(REBUILT % ("1.0", before, "2.0", call))
    assert lines[0].startswith("Error: Point ") and "make a new field" in lines[0]


def test_the_same_geometry_built_again_is_as_good():
    assert run(REBUILT % ("1.0", "field.refresh()", "1.0", "field.generate, 2")) == ["no error"]


def test_another_radius_with_the_same_tags_is_noticed():
    lines = run("""
        volume = models.single(lambda occ: occ.addSphere(0, 0, 0, 1))
        field = meshgrow.SizeField()
        field.add_curvature([volume], [volume], size_limit=0.5)
        field.refresh()
        gmsh.model.remove()
        models.single(lambda occ: occ.addSphere(0, 0, 0, 0.5))
        told(field.generate, 3)
        """)
    assert lines[0].startswith("Error: Point ")
