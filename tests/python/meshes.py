"""Makes, reads and compares meshes through Gmsh's API."""

import collections
import contextlib

import gmsh
import numpy as np

CORNERS = {"Line": 2, "Triangle": 3, "Quadrilateral": 4, "Quadrangle": 4, "Tetrahedron": 4,
           "Pyramid": 5, "Prism": 6, "Hexahedron": 8}


def boundary(entities):
    return gmsh.model.getBoundary(entities, combined=False, oriented=False)


def closure(entities):
    """The entities and all that bounds them."""
    found, fresh = set(), set(entities)
    while fresh:
        found |= fresh
        fresh = {low for e in fresh if e[0] > 0 for low in boundary([e])} - found
    return sorted(found)


@contextlib.contextmanager
def options(**values):
    """Options, with _ for the dot, for the life of a block."""
    names = {name: name.replace("_", ".", 1) for name in values}
    before = {name: gmsh.option.getNumber(names[name]) for name in values}
    for name, value in values.items():
        gmsh.option.setNumber(names[name], value)
    try:
        yield
    finally:
        for name, value in before.items():
            gmsh.option.setNumber(names[name], value)


@contextlib.contextmanager
def size_callback(size_at):
    """`size_at(x, y, z)` as Gmsh's size callback, whatever the version passes besides."""
    gmsh.model.mesh.setSizeCallback(lambda dim, tag, x, y, z, *_: size_at(x, y, z))
    try:
        yield
    finally:
        gmsh.model.mesh.removeSizeCallback()


def premesh(entities, size):
    """Meshes exactly these entities with what bounds them, by `size` or `size(x, y, z)`."""
    size_at = size if callable(size) else lambda *_: size
    wanted = closure(entities)
    everything = gmsh.model.getEntities()
    with options(Mesh_MeshOnlyVisible=1, Mesh_Renumber=0), size_callback(size_at):
        for dim in range(1, 4):
            of_dim = [e for e in wanted if e[0] == dim]
            if of_dim:
                gmsh.model.setVisibility(everything, 0)
                gmsh.model.setVisibility(of_dim, 1)
                gmsh.model.mesh.generate(dim)
        gmsh.model.setVisibility(everything, 1)


def snapshot(entity):
    """All that is promised for a premeshed entity: node tags, coordinates to the bit, elements."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes(*entity)
    types, _, nodes = gmsh.model.mesh.getElements(*entity)
    return ([int(t) for t in tags], np.asarray(coordinates, dtype=float).tobytes(),
            [(int(t), [int(n) for n in block]) for t, block in zip(types, nodes)])


def snapshots(entities):
    return {entity: snapshot(entity) for entity in entities}


def has_elements(entity):
    return len(gmsh.model.mesh.getElementTypes(*entity)) > 0


def element_count(*entities):
    return sum(len(block) for e in entities for block in gmsh.model.mesh.getElements(*e)[1])


def node_positions():
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    positions = np.full((int(max(tags)) + 1, 3), np.nan)
    positions[np.asarray(tags, dtype=int)] = np.asarray(coordinates).reshape(-1, 3)
    return positions


def corner_tags(entity, name):
    """Node tags of the corners of all elements of an entity whose type's name begins so."""
    blocks = [np.zeros((0, CORNERS[name]), dtype=int)]
    types, _, nodes = gmsh.model.mesh.getElements(*entity)
    for kind, block in zip(types, nodes):
        properties = gmsh.model.mesh.getElementProperties(kind)
        if properties[0].startswith(name):
            block = np.asarray(block, dtype=int).reshape(-1, properties[3])
            blocks.append(block[:, :CORNERS[name]])
    return np.concatenate(blocks)


def corners(entity, name):
    """Corner coordinates (n, corners, 3) of those elements."""
    return node_positions()[corner_tags(entity, name)]


def quad_corners(entity):
    # Gmsh 4.8 says Quadrilateral, others may say Quadrangle.
    return np.concatenate((corners(entity, "Quadrilateral"), corners(entity, "Quadrangle")))


def signed_volumes(volume):
    a, b, c, d = np.moveaxis(corners(volume, "Tetrahedron"), 1, 0)
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def random_points(count, low, high, seed=1):
    return np.random.default_rng(seed).uniform(low, high, (count, 3))


class Log:
    """Messages of Gmsh's log within a block."""

    def __enter__(self):
        gmsh.logger.start()
        self.messages = []
        return self

    def __exit__(self, *_):
        self.messages = list(gmsh.logger.get())
        gmsh.logger.stop()

    @property
    def warnings(self):
        return [m for m in self.messages if m.startswith("Warning: ")]


CELL_FACES = {
    "Tetrahedron": ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)),
    "Pyramid": ((0, 1, 2, 3), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "Prism": ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "Hexahedron": ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6),
                   (3, 0, 4, 7))}
FACE_SIDES = {
    "Triangle": ((0, 1), (1, 2), (2, 0)),
    "Quadrilateral": ((0, 1), (1, 2), (2, 3), (3, 0)),
    "Quadrangle": ((0, 1), (1, 2), (2, 3), (3, 0))}


def count_sides(entity, sides_of):
    """How often each set of nodes is a side of an element of the entity."""
    return collections.Counter(
        frozenset(element[list(side)].tolist()) for name, sides in sides_of.items()
        for element in corner_tags(entity, name) for side in sides)


def cells_of(entity, names):
    return [frozenset(c) for name in names for c in corner_tags(entity, name).tolist()]


def assert_conforming(*volumes):
    """Volume meshes of any elements are closed and end at the meshes of their faces."""
    for volume in volumes:
        sides = count_sides(volume, CELL_FACES)
        assert sides and max(sides.values()) == 2
        on_faces = [c for f in boundary([volume]) for c in cells_of(f, FACE_SIDES)]
        assert len(set(on_faces)) == len(on_faces)
        assert {side for side, count in sides.items() if count == 1} == set(on_faces)


def assert_conforming_surfaces(*surfaces):
    """Surface meshes end at the meshes of their curves; seams are in them, from both sides."""
    for surface in surfaces:
        sides = count_sides(surface, FACE_SIDES)
        assert sides and max(sides.values()) == 2
        on_curves = {c for b in boundary([surface]) for c in cells_of(b, ["Line"])}
        assert {side for side, count in sides.items() if count == 1} <= on_curves
        assert on_curves <= set(sides)


def cells_along(entities, start, end):
    """Elements (triangles in a plane z = const, or tetrahedra) along a line: its length over their
    mean edge lengths, integrated."""
    start = np.asarray(start, dtype=float)
    way = np.asarray(end, dtype=float) - start
    count = 0.0
    for entity in entities:
        dim = entity[0]
        corner = corners(entity, "Tetrahedron" if dim == 3 else "Triangle")
        edges = np.mean([np.linalg.norm(corner[:, i] - corner[:, j], axis=1)
                         for i in range(dim + 1) for j in range(i)], axis=0)
        inverse = np.linalg.inv(np.moveaxis(corner[:, 1:, :dim] - corner[:, :1, :dim], 1, 2))
        # Barycentric coordinates are linear along the line: at + t * by.
        at = np.einsum("nij,nj->ni", inverse, (start - corner[:, 0])[:, :dim])
        by = np.einsum("nij,j->ni", inverse, way[:dim])
        at = np.column_stack((1 - at.sum(axis=1), at))
        by = np.column_stack((-by.sum(axis=1), by))
        with np.errstate(divide="ignore", invalid="ignore"):
            zero = -at / by
        enter = np.maximum(np.where(by > 0, zero, -np.inf).max(axis=1), 0)
        leave = np.minimum(np.where(by < 0, zero, np.inf).min(axis=1), 1)
        missed = ((by == 0) & (at < 0)).any(axis=1)
        part = np.where(missed, 0, np.maximum(leave - enter, 0))
        count += (part * np.linalg.norm(way) / edges).sum()
    return count


def everything_in_the_model():
    """What a reader of the model must not change: entities, meshes, groups, models, options."""
    option_names = ["Mesh.MeshSizeMin", "Mesh.MeshSizeMax", "Mesh.MeshSizeFactor", "Mesh.Algorithm",
                    "Mesh.MeshSizeFromCurvature", "Mesh.MeshOnlyVisible", "Mesh.Renumber",
                    "Mesh.ElementOrder", "Geometry.Tolerance", "Mesh.MeshSizeExtendFromBoundary"]
    known = []
    for name in option_names:
        try:
            known.append((name, gmsh.option.getNumber(name)))
        except Exception:  # 4.8 calls some by other names
            pass
    entities = gmsh.model.getEntities()
    return (entities, snapshots(entities), gmsh.model.getPhysicalGroups(), gmsh.model.list(),
            gmsh.model.getCurrent(), known, [gmsh.model.getVisibility(*e) for e in entities])
