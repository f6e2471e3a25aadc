"""Reads the elements of a mesh and measures their sizes: the mean edge length."""

import numpy as np

from errors import RenderError, abridged, tidy

# The edges of an element, as pairs of its corner nodes in Gmsh's numbering;
# the key is (dimension, number of corners).
ELEMENT_EDGES = {
    (2, 3): ((0, 1), (1, 2), (2, 0)),
    (2, 4): ((0, 1), (1, 2), (2, 3), (3, 0)),
    (3, 4): ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    (3, 5): ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)),
    (3, 6): ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4),
             (2, 5)),
    (3, 8): ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
             (0, 4), (1, 5), (2, 6), (3, 7)),
}
# What to call the elements when all of them have this shape.
ELEMENT_NAMES = {(2, 3): "triangles", (2, 4): "quadrangles",
                 (3, 4): "tetrahedra", (3, 8): "hexahedra"}


class Mesh:
    """The drawn elements of one mesh.

    tags:     Gmsh's element tags
    sizes:    mean edge length per element, in the unit of the mesh
    corners:  list of arrays (elements, corners, 3) with coordinates
    name:     what to call the elements
    """

    def __init__(self, tags, sizes, corners, name):
        self.tags = tags
        self.sizes = sizes
        self.corners = corners
        self.name = name


def start_gmsh(gmsh):
    """Start Gmsh quietly; neither use nor change the user's settings."""
    gmsh.initialize(readConfigFiles=False)
    for name in ("Terminal", "SaveSession", "SaveOptions"):
        gmsh.option.setNumber("General." + name, 0)


def read_mesh(gmsh, path, dimension, entity_tags):
    """Open a mesh in the running Gmsh and measure its elements."""
    try:
        gmsh.open(str(path))
        types, tags, nodes = collect_elements(gmsh, dimension, entity_tags)
        node_tags, coordinates, _ = gmsh.model.mesh.getNodes()
    except RenderError:
        raise
    except Exception as error:  # gmsh raises plain Exception
        raise RenderError(f"Gmsh cannot read '{path}' ({tidy(error)}); write "
                          "it again as a Gmsh .msh file.") from None
    if not len(types):  # a list or, in newer Gmsh, an array
        other = 5 - dimension
        raise RenderError(
            f"'{path}' has no elements of dimension {dimension}"
            f"{' in these entities' if entity_tags else ''}; mesh it in "
            f"{dimension}D first, or try --dim {other}.")
    order = np.argsort(node_tags)
    sorted_tags = np.asarray(node_tags)[order]
    points = np.asarray(coordinates).reshape(-1, 3)[order]
    sizes, corners, shapes = [], [], set()
    for element_type, node_list in zip(types, nodes):
        _, dim, _, total, _, primary = element_properties(gmsh, element_type)
        edges = ELEMENT_EDGES.get((dim, primary))
        if edges is None:
            raise RenderError(f"'{path}' has elements that are not drawn "
                              f"here (Gmsh type {element_type}); convert the "
                              "mesh to tetrahedra or triangles.")
        # The corner nodes come first, also in elements of higher order.
        first = np.asarray(node_list).reshape(-1, total)[:, :primary]
        xyz = points[np.searchsorted(sorted_tags, first)]
        sizes.append(mean_edge_length(xyz, edges))
        corners.append(xyz)
        shapes.add((dim, primary))
    name = ELEMENT_NAMES.get(shapes.pop()) if len(shapes) == 1 else None
    return Mesh(np.concatenate(tags), np.concatenate(sizes), corners,
                name or "elements")


def collect_elements(gmsh, dimension, entity_tags):
    """Return element types, element tags and node tags, as Gmsh does."""
    if not entity_tags:
        return gmsh.model.mesh.getElements(dimension)
    known = {tag for _, tag in gmsh.model.getEntities(dimension)}
    result = ([], [], [])
    for entity in entity_tags:
        if entity not in known:
            kind = "volume" if dimension == 3 else "surface"
            raise RenderError(
                f"there is no {kind} {entity} in the mesh; leave it out of "
                f"--volumes (there are {abridged(sorted(known))}).")
        for part, found in zip(result, gmsh.model.mesh.getElements(
                dimension, entity)):
            part.extend(found)
    return result


def element_properties(gmsh, element_type):
    """Return name, dimension, order, nodes, coordinates, corner nodes."""
    return gmsh.model.mesh.getElementProperties(element_type)[:6]


def mean_edge_length(xyz, edges):
    """Return the mean edge length of each element, in the mesh's unit."""
    lengths = [np.linalg.norm(xyz[:, a] - xyz[:, b], axis=1)
               for a, b in edges]
    return np.mean(lengths, axis=0)


def measure_file(gmsh, path, dimension, entity_tags):
    """Read a mesh without drawing it."""
    start_gmsh(gmsh)
    try:
        return read_mesh(gmsh, path, dimension, entity_tags)
    finally:
        gmsh.finalize()


def common_range(meshes):
    """Return the smallest and largest element size over all meshes."""
    low = float(min(mesh.sizes.min() for mesh in meshes))
    high = float(max(mesh.sizes.max() for mesh in meshes))
    if low <= 0:
        raise RenderError("a mesh has elements of size zero; remove them, as "
                          "a logarithmic scale cannot show them.")
    if high < 1.001 * low:  # a uniform mesh: keep the scale from collapsing
        low, high = low / 1.1, high * 1.1
    return low, high
