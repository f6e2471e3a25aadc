"""What is checked after each model."""

import os
import tempfile

import gmsh
import meshgrow
import numpy as np

from meshes import (boundary, corner_tags, corners, element_count, has_elements, node_positions,
                    signed_volumes, snapshot)

FLAT = 1e-9  # volume of a tetrahedron over the cube of an edge that is none
STEEP = 1.5  # the most that 99 % of neighbours may differ by
MANY = 1000  # tetrahedra from which on the sizes of a volume are judged


def changed_options():
    """All options of Gmsh that have not their default, as text."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "options.opt")
        gmsh.write(path)
        with open(path) as file:
            return "".join(line for line in file 
                       if "read-only" not in line and not line.startswith("View["))


def visibility():
    return {e: gmsh.model.getVisibility(*e) for e in gmsh.model.getEntities()}


class Before:
    """What must be the same after meshing."""

    def __init__(self):
        self.meshes = {e: snapshot(e) for e in gmsh.model.getEntities() if e[0] > 0
                       and has_elements(e)}
        self.options = changed_options()
        self.visibility = visibility()

    def differences(self):
        found = ["%s of %s changed" % (what, entity)
                 for entity, before in self.meshes.items()
                 for what, a, b in zip(("node tags", "coordinates", "elements"), before,
                                       snapshot(entity)) if a != b]
        if changed_options() != self.options:
            found.append("options changed: %r" % set(changed_options().splitlines()).difference(
                self.options.splitlines()))
        if visibility() != self.visibility:
            found.append("visibility changed")
        return found


def sides_of(elements):
    """Each side of simplices (n, corners) once: nodes (sides, corners - 1), sorted, and counts."""
    corners_of = range(elements.shape[1])
    sides = np.sort(np.concatenate([np.delete(elements, i, axis=1) for i in corners_of]), axis=1)
    return np.unique(sides, axis=0, return_counts=True)


def relative_volumes(volume):
    """Signed volumes of tetrahedra over the cube of their first edges."""
    first = corners(volume, "Tetrahedron")[:, :2]
    return signed_volumes(volume) / np.linalg.norm(first[:, 1] - first[:, 0], axis=1) ** 3


def flat_tetrahedra():
    """Gmsh leaves some in corners of less than an element, and warns of them as ill-shaped."""
    return sum(int((relative_volumes(v) < FLAT).sum()) for v in gmsh.model.getEntities(3)
               if has_elements(v))


def invalid():
    """What is wrong with the volumes' meshes, in words."""
    found = []
    for volume in gmsh.model.getEntities(3):
        if not has_elements(volume):
            found.append("%s has no mesh" % (volume,))
            continue
        if relative_volumes(volume).min() < -FLAT:
            found.append("%s has inverted tetrahedra" % (volume,))
        sides, counts = sides_of(corner_tags(volume, "Tetrahedron"))
        on_faces = np.concatenate([corner_tags(f, "Triangle") for f in boundary([volume])])
        on_faces, times = np.unique(np.sort(on_faces, axis=1), axis=0, return_counts=True)
        on_faces = on_faces[times == 1]  # Gmsh folds some flat at the tips of cones
        if counts.max() > 2 or not np.array_equal(sides[counts == 1], on_faces):
            found.append("%s does not end at the meshes of its faces" % (volume,))
    tags = gmsh.model.mesh.getNodes()[0]
    if len(set(tags)) != len(tags):
        found.append("nodes are there twice")
    return found


def size_ratios(volume):
    """Of neighbours in a volume: the ratio of sizes, and the nodes of both (pairs, 8)."""
    tags = corner_tags(volume, "Tetrahedron")
    points = corners(volume, "Tetrahedron")
    sizes = np.mean([np.linalg.norm(points[:, i] - points[:, j], axis=1)
                     for i in range(4) for j in range(i)], axis=0)
    faces = np.sort(np.concatenate([np.delete(tags, i, axis=1) for i in range(4)]), axis=1)
    owners = np.tile(np.arange(len(tags)), 4)
    order = np.lexsort(faces.T)
    same = np.all(faces[order[1:]] == faces[order[:-1]], axis=1)
    a, b = owners[order[:-1][same]], owners[order[1:][same]]
    ratios = np.maximum(sizes[a], sizes[b]) / np.minimum(sizes[a], sizes[b])
    return ratios, np.concatenate((tags[a], tags[b]), axis=1)


def face_edges(volume, field):
    """Edges of the triangles around a volume: nodes (n, 2), and length over the size that the
    volume's functions ask for there."""
    triangles = np.concatenate([corner_tags(f, "Triangle") for f in boundary([volume])])
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges = np.unique(edges, axis=0)
    a, b = np.moveaxis(node_positions()[edges], 1, 0)
    return edges, np.linalg.norm(b - a, axis=1) / field.size(*volume, (a + b) / 2)


def causes(volume, premeshed, field):
    """Numbers that tell why sizes jump in a volume: how many pairs of neighbours do, and which part
    of these, and of all, is at nodes of the mesh from before, of too short and of too long edges
    on faces."""
    ratios, nodes = size_ratios(volume)
    bad = ratios > STEEP
    faces = [f for f in boundary([volume]) if f in premeshed]
    edges, lengths = face_edges(volume, field)
    places = {"premeshed": [n for f in faces for n in corner_tags(f, "Triangle").ravel()],
              "shorter": edges[lengths < 0.6].ravel(), "longer": edges[lengths > 1.7].ravel()}
    result = {"pairs": len(ratios), "bad": int(bad.sum()),
              "faces": meshgrow.report(2, boundary([volume]))}
    for place, tags in places.items():
        there = np.isin(nodes, np.unique(tags)).any(axis=1)
        result[place] = {"of_bad": float(there[bad].mean()), "of_all": float(there.mean())}
    if faces:
        result["premeshed"].update(meshgrow.report(2, faces))
    return result


def measure_volumes(field, premeshed):
    """Of each volume that a function acts on and that had no mesh: elements and their sizes."""
    result = []
    for volume in gmsh.model.getEntities(3):
        if volume in premeshed:
            continue
        report = meshgrow.report(3, [volume], field)
        if report["length_median"] is None:
            continue  # nothing acts on it
        entry = {"volume": volume[1], "tetrahedra": element_count(volume), "report": report}
        if report["ratio_99"] and report["ratio_99"] > STEEP and entry["tetrahedra"] > MANY:
            entry["causes"] = causes(volume, premeshed, field)
        result.append(entry)
    return result
