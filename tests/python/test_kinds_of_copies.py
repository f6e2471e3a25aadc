"""Entities that Gmsh meshes along with others: extruded layers, periodic copies, compounds.
Premeshed they are kept to the bit, unmeshed they match what they belong to."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from kinds import (coordinates, face_at, grow, grow_fixed, quads_in, triangles_in)
from meshes import (assert_conforming, assert_conforming_surfaces, boundary, cells_of, closure,
                    corner_tags, element_count, has_elements, node_positions, options, premesh,
                    snapshots)

# ==== Extruded layers ====


def extruded_box(kernel, recombine):
    """A square of side 1 extruded in 4 layers by 0.8; bottom, top, sides, volume."""
    models.start("extruded")
    make = getattr(gmsh.model, kernel)
    if kernel == "geo":
        corner = [make.addPoint(x, y, 0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        lines = [make.addLine(corner[i], corner[(i + 1) % 4]) for i in range(4)]
        bottom = make.addPlaneSurface([make.addCurveLoop(lines)])
    else:
        bottom = make.addRectangle(0, 0, 0, 1, 1)
    made = make.extrude([(2, bottom)], 0, 0, 0.8, numElements=[4], recombine=recombine)
    make.synchronize()
    return (2, bottom), made[0], [e for e in made[2:] if e[0] == 2], made[1]


def over(surface, height):
    return {tuple(p) for p in (coordinates(surface) + (0, 0, height)).round(6)}


def assert_layers(bottom, top, sides, volume, recombine):
    assert over(bottom, 0.8) == over(top, 0.0)
    heights = np.unique(coordinates(volume)[:, 2].round(6)) if recombine else [.2, .4, .6]
    assert np.allclose(heights, [.2, .4, .6])
    prisms = 4 * triangles_in(bottom)
    assert len(corner_tags(volume, "Prism")) == (prisms if recombine else 0)
    assert len(corner_tags(volume, "Tetrahedron")) == (0 if recombine else 3 * prisms)
    assert quads_in(*sides) == (sum(element_count(c) for c in boundary([bottom])) * 4
                                if recombine else 0)
    assert_conforming(volume)


LAYERS = [pytest.mark.parametrize("recombine", [False, True], ids=["tetrahedra", "prisms"]),
          pytest.mark.parametrize("kernel", ["geo", "occ"])]


def layered(test):
    for mark in LAYERS:
        test = mark(test)
    return test


@layered
def test_extruded_volume_has_its_layers(kernel, recombine):
    """Gmsh copies a curve or surface only in the pass that meshes what it is a copy of."""
    bottom, top, sides, volume = extruded_box(kernel, recombine)
    with options(Mesh_MeshSizeMax=0.3):
        grow([bottom], [volume])
    assert_layers(bottom, top, sides, volume, recombine)


@layered
def test_premeshed_extruded_volume_is_kept(kernel, recombine):
    bottom, top, sides, volume = extruded_box(kernel, recombine)
    premesh([volume], lambda x, y, z: 0.15 + 0.1 * x)
    before = snapshots(closure([volume]))
    grow([bottom], [volume])
    assert snapshots(before) == before
    assert_layers(bottom, top, sides, volume, recombine)


@pytest.mark.parametrize("kernel", ["geo", "occ"])
def test_premeshed_faces_of_extruded_prisms_are_kept_and_the_layers_laid_in(kernel):
    bottom, top, sides, volume = extruded_box(kernel, True)
    premesh([bottom, top] + sides, lambda x, y, z: 0.15 + 0.1 * x)
    before = snapshots(closure([bottom, top] + sides))
    grow([bottom], [volume])
    assert snapshots(before) == before
    assert_layers(bottom, top, sides, volume, True)


@pytest.mark.parametrize("kernel", ["geo", "occ"])
def test_premeshed_faces_of_extruded_tetrahedra_are_told_as_not_fitting(kernel):
    """Gmsh chooses the diagonals of all sides anew when it divides the layers."""
    bottom, top, sides, volume = extruded_box(kernel, False)
    premesh([bottom, top] + sides, lambda x, y, z: 0.15 + 0.1 * x)
    before = snapshots(closure([bottom, top] + sides))
    with pytest.raises(meshgrow.Error, match="Volume %d.*does not fit" % volume[1]):
        grow([bottom], [volume])
    assert snapshots(before) == before
    assert not has_elements(volume)


@layered
def test_layers_on_a_premeshed_bottom_alone_are_told_as_impossible(kernel, recombine):
    """Gmsh copies nothing from what it has not meshed in the same pass."""
    bottom, top, sides, volume = extruded_box(kernel, recombine)
    premesh([bottom], lambda x, y, z: 0.15 + 0.1 * x)
    before = snapshots(closure([bottom]))
    with pytest.raises(meshgrow.Error, match="pass .*Surface.*extruded"):
        grow([bottom], [volume])
    assert snapshots(before) == before


def extruded_curve():
    """A unit line extruded to a surface in layers of 2 and 3 elements; line, copy, surface."""
    models.start("extruded curve")
    geo = gmsh.model.geo
    line = geo.addLine(geo.addPoint(0, 0, 0), geo.addPoint(1, 0, 0))
    made = geo.extrude([(1, line)], 0, 0.5, 0, numElements=[2, 3], heights=[.4, 1.0],
                       recombine=True)
    geo.synchronize()
    return (1, line), made[0], made[1]


def test_extruded_curve_makes_a_layered_surface():
    line, copy, surface = extruded_curve()
    with options(Mesh_MeshSizeMax=0.2):
        grow([line], [surface], 2)
    assert quads_in(surface) == 5 * element_count(line) == element_count(surface)
    assert over(line, 0.0) and {p[0] for p in over(line, 0)} == {p[0] for p in over(copy, 0)}


def test_premeshed_curve_extruded_to_layers_is_told_as_impossible():
    line, _, surface = extruded_curve()
    premesh([line], lambda x, y, z: 0.05 + 0.1 * x)
    before = snapshots(closure([line]))
    with pytest.raises(meshgrow.Error, match="pass .*Surface %d.*extruded" % surface[1]):
        grow([line], [surface], 2)
    assert snapshots(before) == before


# ==== Periodic curves and surfaces ====

SHIFT = [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]  # by 1 along x


def periodic_box():
    """A unit box whose face at x = 1 is a copy of that at x = 0."""
    volume = models.box()
    master, copy = face_at(volume, 0, 0.0), face_at(volume, 0, 1.0)
    gmsh.model.mesh.setPeriodic(2, [copy[1]], [master[1]], SHIFT)
    return volume, master, copy


def node_pairs(entity):
    """Tag of the master, and which node is a copy of which."""
    master, nodes, master_nodes = gmsh.model.mesh.getPeriodicNodes(*entity)[:3]
    return master, dict(zip(map(int, nodes), map(int, master_nodes)))


def assert_periodic(copy):
    """Each node of the copy, those on its boundary included, is a copy, and the elements match."""
    below = [e for e in closure([copy]) if e[0] > 0]
    positions = node_positions()
    for entity in below:
        master, pairs = node_pairs(entity)
        assert master != entity[1]
        name = "Line" if entity[0] == 1 else "Triangle"
        assert set(pairs) == set(corner_tags(entity, name).ravel().tolist())
        for node, other in pairs.items():
            assert positions[node] == pytest.approx(positions[other] + (1, 0, 0), abs=1e-9)
        copied = {frozenset(pairs[n] for n in c) for c in cells_of(entity, [name])}
        assert copied == set(cells_of((entity[0], master), [name]))


def test_periodic_surface_is_meshed_as_a_copy():
    volume, master, copy = periodic_box()
    top = face_at(volume, 2, 1.0)
    premesh([], 0.2)
    grow_fixed([top], [volume], 0.1)
    assert_periodic(copy)
    assert_conforming(volume)


@pytest.mark.parametrize("order", [1, 2])
def test_premeshed_periodic_surfaces_are_kept_with_their_correspondence(order):
    volume, master, copy = periodic_box()
    premesh([master, copy], lambda x, y, z: 0.15 + 0.1 * z)
    gmsh.model.mesh.setOrder(order)
    before = snapshots(closure([master, copy]))
    pairs = {e: node_pairs(e) for e in closure([copy]) if e[0] > 0}
    assert_periodic(copy)
    with options(Mesh_ElementOrder=order):
        grow([master], [volume])
    assert snapshots(before) == before
    assert {e: node_pairs(e) for e in pairs} == pairs
    assert_conforming(volume)


def test_unmeshed_source_with_a_periodic_copy_that_is_no_source():
    """The copy goes with its master into one pass: Gmsh copies only what it meshed in it."""
    volume, master, copy = periodic_box()
    with options(Mesh_MeshSizeMax=0.25):
        grow([master], [volume])
    assert_periodic(copy)
    assert_conforming(volume)


def test_copy_of_a_premeshed_periodic_surface_is_made_to_match_it():
    volume, master, copy = periodic_box()
    premesh([master], lambda x, y, z: 0.15 + 0.1 * z)
    assert not has_elements(copy)
    before = snapshots(closure([master]))
    grow([master], [volume])
    assert snapshots(before) == before
    assert_periodic(copy)
    assert_conforming(volume)


def test_copy_of_a_premeshed_face_turned_about_an_axis():
    """A sector of a ring, one cut of which is the other, turned by 60 degrees."""
    models.start("sector")
    occ = gmsh.model.occ
    profile = (2, occ.addRectangle(1, 0, 0, 1, 1))
    occ.rotate([profile], 0, 0, 0, 1, 0, 0, np.pi / 2)
    made = occ.revolve([profile], 0, 0, 0, 0, 0, 1, np.pi / 3)
    occ.synchronize()
    volume = next(e for e in made if e[0] == 3)
    cuts = [f for f in gmsh.model.getEntities(2) if gmsh.model.getType(*f) == "Plane"
            and abs(occ.getCenterOfMass(*f)[2] - 0.5) < 1e-6]
    master, copy = sorted(cuts, key=lambda f: occ.getCenterOfMass(*f)[1])
    c, s = np.cos(np.pi / 3), np.sin(np.pi / 3)
    gmsh.model.mesh.setPeriodic(2, [copy[1]], [master[1]],
                                [c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
    premesh([master], lambda x, y, z: 0.1 + 0.1 * z)
    before = snapshots(closure([master]))
    grow([master], [volume])
    assert snapshots(before) == before
    assert element_count(copy) == element_count(master)
    tag, pairs = node_pairs(copy)
    positions = node_positions()
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    assert tag == master[1] and pairs
    for node, other in pairs.items():
        assert positions[node] == pytest.approx(turn @ positions[other], abs=1e-9)
    assert_conforming(volume)


def test_a_chain_of_copies_passes_the_mesh_on():
    models.start("chain of squares")
    occ = gmsh.model.occ
    squares = [(2, occ.addRectangle(x, 0, 0, 1, 1)) for x in range(3)]
    occ.fragment(squares[:1], squares[1:])
    occ.synchronize()
    across = sorted((e for e in gmsh.model.getEntities(1)
                     if abs(occ.getCenterOfMass(*e)[1] - 0.5) < 1e-6),
                    key=lambda e: occ.getCenterOfMass(*e)[0])
    for master, copy in zip(across, across[1:]):
        gmsh.model.mesh.setPeriodic(1, [copy[1]], [master[1]], SHIFT)
    grow_fixed(across[:1], gmsh.model.getEntities(2), 0.05, 2)
    assert [element_count(e) for e in across] == [20] * 4
    assert_conforming_surfaces(*gmsh.model.getEntities(2))


def test_periodic_curves_are_meshed_as_copies_beside_a_premeshed_curve():
    model = models.square()
    gmsh.model.mesh.setPeriodic(1, [model.right[1]], [model.left[1]], SHIFT)
    premesh([model.bottom], 0.05)
    before = snapshots(closure([model.bottom]))
    grow([model.bottom], [model.face], 2)
    assert snapshots(before) == before
    assert_periodic(model.right)
    assert_conforming_surfaces(model.face)


# ==== Compounds ====


def compound_squares(dim):
    """Three unit squares side by side; the first two, or their curves at y = 0, as a compound."""
    models.start("compound")
    occ = gmsh.model.occ
    squares = [(2, occ.addRectangle(x, 0, 0, 1, 1)) for x in range(3)]
    occ.fragment(squares[:1], squares[1:])
    occ.synchronize()
    faces = sorted(gmsh.model.getEntities(2), key=lambda f: occ.getCenterOfMass(*f)[0])
    parts = faces[:2] if dim == 2 else [
        c for f in faces[:2] for c in boundary([f]) if abs(occ.getCenterOfMass(*c)[1]) < 1e-6]
    assert len(parts) == 2
    gmsh.model.mesh.setCompound(dim, [tag for _, tag in parts])
    return faces, parts


@pytest.mark.parametrize("dim", [1, 2], ids=["curves", "surfaces"])
def test_premeshed_compound_is_kept(dim):
    faces, parts = compound_squares(dim)
    premesh(parts, 0.1)
    before = snapshots(closure(parts))
    grow(parts, faces[2:] if dim == 2 else faces, 2)
    assert snapshots(before) == before
    assert all(has_elements(f) for f in faces)


def test_compound_of_surfaces_has_the_sizes_of_its_parts():
    faces, _ = compound_squares(2)
    field = meshgrow.SizeField()
    field.add_fixed(faces, faces, 0.1, 1.0, 0.1)
    field.generate(2)
    assert element_count(*faces) == pytest.approx(3 / (0.1**2 * np.sqrt(3) / 4), rel=0.25)


@pytest.mark.parametrize("dim", [1, 2], ids=["curves", "surfaces"])
def test_a_second_run_after_compounds_were_meshed_changes_nothing(dim):
    faces, _ = compound_squares(dim)
    field = meshgrow.SizeField()
    field.add_fixed(faces, faces, 0.2, 1.0, 0.2)
    field.generate(2)
    before = snapshots(gmsh.model.getEntities())
    field.generate(2)
    assert snapshots(before) == before
