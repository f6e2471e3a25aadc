"""The limit of the memory that background grids take."""

import gmsh
import meshgrow
import pytest

import child
import meshes
import models


def small_field(**options):
    """Of a volume around a sphere; its grid, without a limit, has far more than 2,000 cells."""
    model = models.sphere_in_box(3.0)
    meshes.premesh([model.sphere], 0.05)
    field = meshgrow.SizeField(evaluator="grid", threads=1, **options)
    field.add_mesh([model.sphere], [model.outer], 1.3, 0.8)
    return model, field


def grid_of(field, volume):
    group = next(g for g in field.statistics()["groups"] if list(volume) in g["entities"])
    return group["grid"]


def warnings_during(action):
    gmsh.logger.start()
    try:
        action()
        return [line for line in gmsh.logger.get() if line.startswith("Warning")]
    finally:
        gmsh.logger.stop()


def test_a_limited_grid_is_coarser_warns_and_keeps_the_tolerance():
    model, field = small_field(max_cells=2000)
    warnings = warnings_during(field.refresh)
    assert len(warnings) == 1, warnings
    assert "Volume %d" % model.outer[1] in warnings[0]
    assert "more than 2,000 cells" in warnings[0] and "raise max_cells" in warnings[0]
    grid = grid_of(field, model.outer)
    assert grid["limited"]
    assert grid["interpolated_cells"] + grid["exact_cells"] <= 2000
    points = [[0.6 + 0.01 * i, 0.7, 0.02 * i] for i in range(40)]
    sizes = field.size(*model.outer, points)
    for size, exact in zip(sizes, field.exact_size(*model.outer, points)):
        assert size <= 1.05 * exact


def test_without_a_limit_memory_suffices_for_small_grids():
    model, field = small_field()
    assert warnings_during(field.refresh) == []
    grid = grid_of(field, model.outer)
    assert not grid["limited"]
    assert grid["interpolated_cells"] + grid["exact_cells"] > 2000


@pytest.mark.parametrize("wrong", [7, -1, 1e9, float("nan")])
def test_a_limit_outside_its_range_is_an_error(wrong):
    models.box()
    with pytest.raises(meshgrow.Error, match="give a number from 8 to 400 million, or 0"):
        meshgrow.SizeField(max_cells=wrong)


def test_a_written_field_tells_the_tolerance_reached(tmp_path):
    _, field = small_field(max_cells=5000)
    field.refresh()
    warnings = warnings_during(lambda: field.write_view(str(tmp_path / "sizes.pos")))
    assert any("interpolated sizes are within" in line for line in warnings), warnings


def test_little_memory_gives_a_coarser_grid_and_no_abort():
    """The default limit comes from the address space that is left to the process."""
    answer = child.run_child("""
import resource
import gmsh
import meshes
import meshgrow
import models
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
model = models.sphere_in_box(3.0)
meshes.premesh([model.sphere], 0.035)
field = meshgrow.SizeField(tolerance=0.0005, evaluator="grid", threads=1)
field.add_mesh([model.sphere], [model.outer], 1.3, 0.8)
field.plan(3)
pages = int(open("/proc/self/statm").read().split()[0])
taken = pages * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (taken + (9 << 20), resource.RLIM_INFINITY))
gmsh.logger.start()
field.refresh()
print([line for line in gmsh.logger.get() if "raise max_cells" in line])
print(field.statistics()["groups"][0]["grid"]["limited"])
""")
    assert "raise max_cells" in answer[0] and answer[1] == "True", answer
