"""Passes that fail in Gmsh, in every dimension, passes on several threads, and Ctrl-C in a pass."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from child import run_child
from meshes import (assert_conforming, boundary, closure, element_count, has_elements, options,
                    premesh, signed_volumes, snapshots)


def mesh_field(sources, attach, growth_rate=1.5, size_limit=0.5):
    field = meshgrow.SizeField()
    field.add_mesh(sources, attach, growth_rate, size_limit)
    return field


def options_and_visibility():
    names = ("Mesh.MeshOnlyVisible", "Mesh.MeshOnlyEmpty", "Mesh.Renumber", "Mesh.ElementOrder",
             "Mesh.MeshSizeExtendFromBoundary", "General.AbortOnError")
    return ([gmsh.option.getNumber(name) for name in names],
            [gmsh.model.getVisibility(*e) for e in gmsh.model.getEntities()])


def hide_every_third():
    for entity in gmsh.model.getEntities()[::3]:
        gmsh.model.setVisibility([entity], 0)


def assert_fails(field, dim, message):
    """The message matches, and options and visibility are as before."""
    hide_every_third()
    gmsh.option.setNumber("Mesh.MeshOnlyEmpty", 1)
    before = options_and_visibility()
    with pytest.raises(meshgrow.Error, match=message):
        field.generate(dim)
    assert options_and_visibility() == before


# ==== Failing passes ====


def square_whose_background_field_fails():
    """A square with a premeshed curve, and a background field that has no file to read."""
    model = models.square()
    premesh([model.bottom], 0.1)
    background = gmsh.model.mesh.field.add("Structured")
    gmsh.model.mesh.field.setString(background, "FileName", "/no/such/file")
    gmsh.model.mesh.field.setAsBackgroundMesh(background)
    return model, background


def test_failing_pass_over_curves_is_named_and_the_premesh_kept():
    model, _ = square_whose_background_field_fails()
    before = snapshots(closure([model.bottom]))
    assert_fails(mesh_field([model.bottom], [model.face]), 2,
                 "pass 1.*Curve %d.*/no/such/file" % model.right[1])
    assert snapshots(before) == before
    assert not has_elements(model.face)


def test_a_run_after_a_failed_one_meshes():
    """Where Gmsh throws an error it stays locked, and would mesh nothing more in the session."""
    model, background = square_whose_background_field_fails()
    before = snapshots(closure([model.bottom]))
    field = mesh_field([model.bottom], [model.face])
    with pytest.raises(meshgrow.Error):
        field.generate(2)
    gmsh.model.mesh.field.remove(background)
    field.generate(2)
    assert snapshots(before) == before
    assert element_count(model.face) > 50
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(2)
    assert has_elements(model.face)


def test_gmsh_locked_by_an_error_of_its_own_generate_is_told():
    """An error that Gmsh throws leaves it locked: it then meshes nothing and says nothing."""
    volume = models.box()
    gmsh.model.mesh.setTransfiniteVolume(volume[1])
    with pytest.raises(Exception):
        gmsh.model.mesh.generate(3)
    model = models.square()
    field = meshgrow.SizeField()
    field.add_fixed([model.face], [model.face], 0.2, 1.2, 0.2)
    with pytest.raises(meshgrow.Error, match="locked.*finalize"):
        field.generate(2)


def test_failing_pass_over_surfaces_is_named_and_what_was_meshed_is_kept():
    """Gmsh maps no ring."""
    models.start("square and ring")
    occ = gmsh.model.occ
    good = (2, occ.addRectangle(3, 0, 0, 1, 1))
    (ring,), _ = occ.cut([(2, occ.addDisk(0, 0, 0, 1, 1))], [(2, occ.addDisk(0, 0, 0, 0.5, 0.5))])
    occ.synchronize()
    gmsh.model.mesh.setTransfiniteSurface(ring[1])
    curves = boundary([ring])
    premesh(curves, 0.2)
    source = boundary([good])[0]
    before = snapshots(closure(curves))
    assert_fails(mesh_field([source], [good]), 2, "pass .*Surface %d.*transfinite" % ring[1])
    assert snapshots(before) == before
    assert all(has_elements(c) for c in gmsh.model.getEntities(1))
    assert element_count(good) > 10


def test_failing_pass_over_volumes_keeps_what_was_meshed_before():
    """Surfaces of this run and the volume of an earlier pass stay; the bad volume is named."""
    model = models.two_boxes()
    premesh(models.faces_of(model.left[1]), 0.3)
    hole = gmsh.model.addDiscreteEntity(2, 99)
    gmsh.model.mesh.addNodes(2, hole, [9001, 9002, 9003, 9004],
                             [1.2, .2, .5, 1.8, .2, .5, 1.5, .8, .5, 1.5, .4, 1.7])
    gmsh.model.mesh.addElementsByType(
        hole, 2, [], [9001, 9003, 9002, 9001, 9002, 9004, 9002, 9003, 9004, 9003, 9001, 9004])
    gmsh.model.mesh.embed(2, [hole], *model.right)  # it pokes through the face above
    kept = models.faces_of(model.left[1]) + [(2, hole)]
    before = snapshots(closure(kept))
    assert_fails(mesh_field([model.between], [model.left]), 3,
                 "Volume %d" % model.right[1])
    assert snapshots(before) == before
    assert all(has_elements(f) for f in gmsh.model.getEntities(2))


def test_a_discrete_surface_that_gmsh_does_not_mesh_again_is_no_copy_of_anything(tmp_path):
    """Surfaces of an STL without a parametrisation: there is nothing to start again for."""
    models.box()
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.3)
    gmsh.model.mesh.generate(2)
    path = str(tmp_path / "box.stl")
    gmsh.write(path)
    gmsh.clear()
    gmsh.merge(path)
    gmsh.model.mesh.classifySurfaces(np.pi / 4)
    surfaces = gmsh.model.getEntities(2)
    gmsh.model.mesh.clear(surfaces[:1])
    before = snapshots(surfaces[1:])
    lines = []
    field = meshgrow.SizeField(progress=lines.append)
    field.add_fixed(surfaces[1:2], surfaces, 0.3, 1.2, 1.0)
    with pytest.raises(meshgrow.Error, match="Surface %d .*no geometry.*createGeometry"
                       % surfaces[0][1]):
        field.generate(2)
    assert not any("again" in line for line in lines)
    assert snapshots(before) == before


# ==== Threads ====


@pytest.mark.parametrize("algorithm", [1, 10], ids=["Delaunay", "HXT"])
@pytest.mark.parametrize("threads", [1, 2, 4])
def test_meshes_made_by_several_threads_are_valid_and_conform(threads, algorithm):
    volumes = models.nested_boxes(2, smallest=2.0)
    inner, outer = volumes
    faces = models.faces_of(inner[1])
    premesh(faces, 0.4)
    before = snapshots(closure(faces))
    with options(General_NumThreads=threads, Mesh_Algorithm3D=algorithm):
        mesh_field(faces, volumes, 1.3, 0.8).generate(3)
    assert snapshots(before) == before
    assert_conforming(inner, outer)
    for volume, size in ((inner, 8.0), (outer, 56.0)):
        assert signed_volumes(volume).min() > 0
        assert signed_volumes(volume).sum() == pytest.approx(size, rel=1e-9)


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_surfaces_and_curves_made_by_several_threads_do_not_depend_on_their_number(threads):
    """Only sources have a mesh in a pass over others, so the sizes are the same."""
    model = models.box_in_box_of(lambda occ: occ.addSphere(0, 0, 0, 1))
    premesh(model.faces, 0.3)
    before = snapshots(closure(model.faces))
    with options(General_NumThreads=threads):
        mesh_field(model.faces, [model.volume], 1.3, 0.8).generate(2)
    assert snapshots(before) == before
    lengths = [element_count(c) for c in gmsh.model.getEntities(1)
               if c not in closure(model.faces)]
    assert lengths == [lengths[0]] * 12
    counts = [element_count(w) for w in model.walls]
    assert max(counts) < 1.2 * min(counts)


# ==== Ctrl-C ====


INTERRUPTED = """
import os, signal
import gmsh, meshgrow
import models
from meshes import closure, has_elements, premesh, snapshots

gmsh.initialize(readConfigFiles=False)
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setNumber("General.NumThreads", 1)
%s
model = models.sphere_in_box()
premesh([model.sphere], 0.3)
before = snapshots(closure([model.sphere]))
asked = []


def sizes(dim, tag, x, y, z, lc=1e22):
    asked.append(dim)
    if asked.count(3) == 5 and dim == 3:  # so that it comes while Gmsh is meshing
        os.kill(os.getpid(), signal.SIGINT)
    return 1e22


field = meshgrow.SizeField()
field.add_mesh([model.sphere], [model.outer], 1.1, 0.25)
field.combine(sizes)
try:
    field.generate(3)
    print("end")
except KeyboardInterrupt:
    print("KeyboardInterrupt")
print(snapshots(before) == before, gmsh.option.getNumber("Mesh.MeshOnlyVisible"))
field = meshgrow.SizeField()
field.add_mesh([model.sphere], [model.outer], 1.5, 1.0)
gmsh.model.mesh.clear([model.inner, model.outer])
field.generate(3)
print(has_elements(model.outer))
"""


def test_interrupt_in_a_pass_is_a_keyboard_interrupt_and_the_premesh_is_kept():
    """With Python's own handler, which acts as soon as Gmsh is through with the pass."""
    lines = run_child(INTERRUPTED % "signal.signal(signal.SIGINT, signal.default_int_handler)")
    assert lines == ["KeyboardInterrupt", "True 0.0", "True"]


def test_interrupt_in_a_pass_ends_the_process_as_gmsh_would_have_it():
    """The module gmsh gives SIGINT back to the system, so that Ctrl-C ends it at once."""
    with pytest.raises(AssertionError, match="exit code -2\\b"):
        run_child(INTERRUPTED % "")
