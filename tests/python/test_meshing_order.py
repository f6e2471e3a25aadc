"""Sources are meshed before what grows from them, whatever the dimensions."""

import gmsh
import meshgrow
import numpy as np
import pytest

import meshes
import models
from meshes import boundary, element_count, has_elements, node_positions, options, premesh, snapshots


def lengths(curve):
    """Lengths of the line elements of a curve and the x of their middles, in order of x."""
    ends = meshes.corners(curve, "Line")
    middles = ends.mean(axis=1)[:, 0]
    order = np.argsort(middles)
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)[order], middles[order]


def curve_between(a, b):
    """The straight curve with these end points."""
    def place(points):
        return sorted(tuple(np.round(p, 6)) for p in points)
    for curve in gmsh.model.getEntities(1):
        ends = [gmsh.model.getValue(0, tag, []) for _, tag in boundary([curve])]
        if place(ends) == place([a, b]):
            return curve
    raise LookupError("no curve from %s to %s" % (a, b))


def pass_of(plan, entity):
    return next(i for i, step in enumerate(plan) if entity in step["entities"])


def follows_field(field, curves):
    """Line elements are no longer than asked for in their middles (Gmsh smooths a little)."""
    for curve in curves:
        ends = meshes.corners(curve, "Line")
        asked = field.size(*curve, ends.mean(axis=1))
        assert (np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) <= 1.25 * asked).all(), curve


# ==== Every pair of dimensions ====


def sources_and_attachments():
    """Two unit boxes; of each dimension an entity at x = 0 and one that touches it."""
    model = models.two_boxes()
    source_face = next(f for f in models.faces_of(model.left[1])
                       if max(abs(x) for x in gmsh.model.getBoundingBox(*f)[::3]) < 1e-3)
    near_face = next(f for f in models.faces_of(model.left[1])
                     if gmsh.model.getBoundingBox(*f)[5] < 1e-3)  # z = 0
    return {"curve": curve_between((0, 0, 0), (0, 1, 0)), "surface": source_face}, \
        {"curve": curve_between((0, 0, 0), (1, 0, 0)), "surface": near_face,
         "volume": model.left}


@pytest.mark.parametrize("attachment", ["curve", "surface", "volume"])
@pytest.mark.parametrize("source", ["curve", "surface"])
def test_a_source_is_meshed_before_what_is_attached_to_it(source, attachment):
    sources, attachments = sources_and_attachments()
    origin, target = sources[source], attachments[attachment]
    field = meshgrow.SizeField()
    field.add_mesh([origin], [target], 1.2, 0.4)
    field.add_fixed([origin], [origin], 0.06, 1.0, 0.06)
    dim = max(origin[0], target[0])
    plan = field.plan(dim)
    own = set(meshes.closure([origin]))
    grown = [e for e in meshes.closure([target]) if e[0] > 0 and e not in own]
    assert grown
    for entity in grown:
        assert pass_of(plan, origin) < pass_of(plan, entity), str(plan)
        assert plan[pass_of(plan, entity)]["attached"]
    field.generate(dim)
    assert all(has_elements(e) for e in grown)
    along = curve_between((0, 0, 0), (1, 0, 0))
    length, _ = lengths(along)
    assert length[0] < 0.1 and length[-1] > 1.5 * length[0]
    follows_field(field, [e for e in grown if e[0] == 1])


def test_a_function_attached_to_a_single_curve_acts_on_that_alone():
    model = models.square(2.0)
    premesh([model.left], 0.05)
    field = meshgrow.SizeField()
    field.add_mesh([model.left], [model.bottom], 1.2, 1.0)
    with options(Mesh_MeshSizeMax=1.0):
        field.generate(1)
    assert element_count(model.bottom) >= 1.5 * element_count(model.top)
    follows_field(field, [model.bottom])


# ==== Passes ====


def chain_of_boxes(count):
    """Unit boxes in a row; volumes and the faces at x = 0, 1, 2, …"""
    models.start("chain")
    occ = gmsh.model.occ
    boxes = [(3, occ.addBox(i, 0, 0, 1, 1, 1)) for i in range(count)]
    occ.fragment(boxes[:1], boxes[1:])
    occ.synchronize()
    volumes = sorted(gmsh.model.getEntities(3), key=lambda e: occ.getCenterOfMass(*e)[0])
    across = {}
    for face in gmsh.model.getEntities(2):
        box = gmsh.model.getBoundingBox(*face)
        if box[3] - box[0] < 1e-3:
            across[round(box[0])] = face
    return volumes, [across[i] for i in range(count + 1)]


def test_a_chain_of_volumes_grows_from_one_to_the_next():
    volumes, faces = chain_of_boxes(3)
    field = meshgrow.SizeField()
    field.add_fixed([faces[0]], [faces[0]], 0.05, 1.0, 0.05)
    for face, volume in zip(faces, volumes):
        field.add_mesh([face], [volume], 1.2, 10.0)
    plan = field.plan(3)
    assert [pass_of(plan, f) for f in faces] == sorted({pass_of(plan, f) for f in faces})
    field.generate(3)
    size = [meshgrow.report(2, [f])["largest_size"] for f in faces]
    # 0.05, then 1/6 more for each unit of distance.
    assert size[0] < 0.07 and 0.15 < size[1] < 0.33 and size[2] > 1.2 * size[1]


def test_the_plan_is_what_generate_does():
    volumes, faces = chain_of_boxes(2)
    told = []
    field = meshgrow.SizeField(progress=told.append)
    field.add_fixed([faces[0]], [volumes[0]], 0.2, 1.2, 1.0)
    field.add_mesh([faces[1]], [volumes[1]], 1.2, 1.0)
    plan = field.plan(3)
    assert not any(has_elements(e) for e in gmsh.model.getEntities())
    planned = [e for step in plan for e in step["entities"]]
    assert sorted(planned) == [e for e in sorted(gmsh.model.getEntities()) if e[0] > 0]
    assert {s for step in plan for s in step["sources"]} == {faces[0], faces[1]}
    text = str(plan)
    for i, step in enumerate(plan, 1):
        assert "Pass %d: dimension %d" % (i, step["dim"]) in text
    field.generate(3)
    assert len([line for line in told if line.startswith("Meshing, pass")]) == len(plan)
    assert field.plan(3) == []
    assert "Nothing to mesh" in str(field.plan(3))


def test_an_embedded_source_curve_comes_before_the_boundary_of_its_surface():
    model = models.square(2.0)
    occ = gmsh.model.occ
    slit = (1, occ.addLine(occ.addPoint(0.6, 1, 0), occ.addPoint(1.4, 1, 0)))
    occ.synchronize()
    gmsh.model.mesh.embed(1, [slit[1]], *model.face)
    field = meshgrow.SizeField()
    field.add_fixed([slit], [slit], 0.03, 1.0, 0.03)
    field.add_mesh([slit], [model.face], 1.2, 1.0)
    plan = field.plan(2)
    assert pass_of(plan, slit) < pass_of(plan, model.bottom) < pass_of(plan, model.face)
    field.generate(2)
    length, middles = lengths(model.bottom)
    # One unit away: 0.03 + 1/6 beside the slit, more towards the corners.
    assert length.min() < 0.25 and abs(middles[length.argmin()] - 1) < 0.5


def test_sources_of_one_function_do_not_wait_for_each_other():
    model = models.box()
    faces = models.faces_of(model[1])
    field = meshgrow.SizeField()
    field.add_mesh(faces[:3], [model], 1.2, 1.0)
    with options(Mesh_MeshSizeMax=0.3):
        field.generate(3)
    assert has_elements(model)


# ==== Meshing again ====


def test_remesh_clears_all_but_the_sources():
    volumes, faces = chain_of_boxes(2)
    premesh([faces[0], volumes[1]], lambda x, y, z: 0.05 if x < 0.5 else 0.7)
    before = snapshots(meshes.closure([faces[0]]))
    coarse = element_count(volumes[1])
    field = meshgrow.SizeField()
    field.add_mesh([faces[0]], volumes, 1.2, 0.12)
    field.generate(3)
    assert element_count(volumes[1]) == coarse
    field.generate(3, remesh=True)
    assert snapshots(meshes.closure([faces[0]])) == before
    assert element_count(volumes[1]) > 2 * coarse
    ends = node_positions()[meshes.corner_tags(volumes[1], "Tetrahedron")]
    assert np.isfinite(ends).all()


def test_remesh_leaves_discrete_entities_their_mesh():
    models.start("discrete")
    tag = gmsh.model.addDiscreteEntity(2)
    gmsh.model.mesh.addNodes(2, tag, [1, 2, 3], [0, 0, 0, 1, 0, 0, 0, 1, 0])
    gmsh.model.mesh.addElementsByType(tag, 2, [1], [1, 2, 3])
    field = meshgrow.SizeField()
    field.generate(2, remesh=True)
    assert element_count((2, tag)) == 1


def test_groups_fields_and_names_of_the_user_are_as_before():
    model = models.two_boxes()
    premesh([model.between], 0.3)
    group = gmsh.model.addPhysicalGroup(2, [model.between[1]])
    gmsh.model.setPhysicalName(2, group, "between")
    background = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(background, "F", "0.4")
    gmsh.model.mesh.field.setAsBackgroundMesh(background)
    gmsh.model.setEntityName(*model.left, "the left one")

    def state():
        groups = gmsh.model.getPhysicalGroups()
        return ([(g, gmsh.model.getPhysicalName(*g),
                  list(gmsh.model.getEntitiesForPhysicalGroup(*g))) for g in groups],
                gmsh.model.getEntities(), gmsh.model.getEntityName(*model.left),
                gmsh.model.getCurrent(), gmsh.option.getNumber("General.Verbosity"))
    before = state()
    field = meshgrow.SizeField()
    field.add_mesh([model.between], [model.right], 1.2, 0.5)
    field.generate(3)
    assert state() == before
    # The background field still rules what is no attachment.
    largest = meshgrow.report(3, [model.left])["largest_size"]
    gmsh.model.mesh.clear()
    gmsh.model.mesh.generate(3)
    assert meshgrow.report(3, [model.left])["largest_size"] == pytest.approx(largest, rel=0.3)
