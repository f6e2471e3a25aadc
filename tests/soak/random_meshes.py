"""Random meshes on some entities of a model, made by plain Gmsh before sizes grow from them."""

import math

import gmsh

from meshes import boundary, closure, has_elements, premesh
from random_shapes import choose, has_length, middle_of_model, model_size

STEEPEST = 0.2  # largest difference of sizes of graded meshes over their distance


def face_size(faces, triangles):
    """Size with which the faces get about so many triangles."""
    area = sum(gmsh.model.occ.getMass(*f) for f in faces)
    return min(math.sqrt(2.3 * area / triangles), model_size() / 8)


def graded(draw, size):
    """A size that grows linearly along a random direction, or a constant one."""
    if draw.random() < 0.3:
        return lambda *_: size
    axis = [draw.gauss(0, 1) for _ in range(3)]
    steepness = draw.uniform(0.0, STEEPEST) / math.hypot(*axis)
    middle = middle_of_model()
    return lambda *point: max(0.4 * size, min(2.5 * size, size + steepness * sum(
        a * (p - m) for a, p, m in zip(axis, point, middle))))


def bunch(draw, curves, intervals):
    """Prescribes numbers of intervals, bunched at ends or in the middle, on some of the curves."""
    for curve in curves:
        kind = draw.choice(["Progression", "Bump"])
        ratio = draw.uniform(1.0, 1.25) if kind == "Progression" else draw.uniform(0.3, 1.0)
        sign = draw.choice([-1, 1]) if kind == "Progression" else 1
        count = max(2, round(intervals * draw.uniform(0.7, 1.4)))
        gmsh.model.mesh.setTransfiniteCurve(curve[1], count + 1, kind, ratio ** sign)


def curves_of(entities):
    return [e for e in closure(entities) if e[0] == 1 and has_length(e)]


def mesh_curves(draw):
    curves = curves_of(gmsh.model.getEntities(3))
    if not curves:
        return None
    chosen = draw.sample(curves, min(len(curves), draw.randint(1, 4)))
    intervals = draw.randint(5, 25)
    length = max(gmsh.model.occ.getMass(*c) for c in chosen)
    bunch(draw, [c for c in chosen if draw.random() < 0.5], intervals)
    return "curves", chosen, graded(draw, length / intervals)


def mesh_faces(draw):
    faces = [e for e in closure(gmsh.model.getEntities(3)) if e[0] == 2]
    chosen = draw.sample(faces, min(len(faces), draw.randint(1, 4)))
    size = face_size(chosen, draw.randint(40, 350))
    if draw.random() < 0.25:
        curve = draw.choice(curves_of(chosen) or [None])
        if curve:
            bunch(draw, [curve], gmsh.model.occ.getMass(*curve) / size)
    return "faces", chosen, graded(draw, size)


def mesh_volume(draw):
    volumes = gmsh.model.getEntities(3)
    if len(volumes) < 2:
        return mesh_faces(draw)
    chosen = draw.choice(volumes)
    size = (8.5 * gmsh.model.occ.getMass(*chosen) / draw.randint(200, 1500)) ** (1 / 3)
    return "volume", [chosen], graded(draw, size)


def is_square(face):
    """Whether a face can be mapped: four curves, none of them twice, with corners between."""
    curves = boundary([face])
    return (len(curves) == 4 == len(set(curves)) and all(map(has_length, curves))
            and len({p for c in curves for p in boundary([c])}) == 4)


def mesh_mapped_face(draw):
    faces = [f for f in closure(gmsh.model.getEntities(3)) if f[0] == 2 and is_square(f)]
    if not faces:
        return mesh_faces(draw)
    face = draw.choice(faces)
    size = face_size([face], draw.randint(40, 300))
    curves = boundary([face])
    for pair in (curves[::2], curves[1::2]):
        length = max(gmsh.model.occ.getMass(*c) for c in pair)
        for curve in pair:
            gmsh.model.mesh.setTransfiniteCurve(curve[1], max(2, round(length / size)) + 1, "Bump",
                                                draw.uniform(0.5, 1.0))
    gmsh.model.mesh.setTransfiniteSurface(face[1])
    return "mapped face", [face], lambda *_: size


def plan_premesh(draw):
    """What is meshed beforehand: words, entities and the size at x, y, z; or None."""
    plan = choose(draw, [(lambda _: None, 20), (mesh_curves, 20), (mesh_faces, 40),
                         (mesh_mapped_face, 10), (mesh_volume, 10)])
    return plan(draw)


def carry_out(plan):
    """Meshes what the plan says; raises RuntimeError with Gmsh's reason if it cannot."""
    _, entities, size = plan
    premesh(entities, size)
    empty = [e for e in closure(entities) if e[0] > 0 and not has_elements(e)
             and not (e[0] == 1 and not has_length(e))]
    if empty:
        raise RuntimeError("Gmsh left %s unmeshed" % empty)
    others = [v for v in gmsh.model.getEntities(3) if v not in entities and has_elements(v)]
    if others:  # a volume enclosed by the one that is meshed
        gmsh.model.mesh.clear(others)
