"""Small models of the tests, made in the current Gmsh session."""

import types

import gmsh

from meshes import boundary


def start(name="model"):
    gmsh.model.add(name)


def faces_of(volume):
    return sorted(boundary([(3, volume)]))


def sphere_in_box(side=6.0, radius=1.0):
    """A box with a sphere in it, both volumes."""
    start("sphere in box")
    box = gmsh.model.occ.addBox(-side / 2, -side / 2, -side / 2, side, side, side)
    ball = gmsh.model.occ.addSphere(0, 0, 0, radius)
    gmsh.model.occ.fragment([(3, box)], [(3, ball)])
    gmsh.model.occ.synchronize()
    volumes = sorted((tag for _, tag in gmsh.model.getEntities(3)),
                     key=lambda tag: gmsh.model.occ.getMass(3, tag))
    inner, outer = volumes
    face = faces_of(inner)[0]
    return types.SimpleNamespace(inner=(3, inner), outer=(3, outer), sphere=face,
                                 walls=[f for f in faces_of(outer) if f != face])


def nested_boxes(count, smallest=1.0):
    """Boxes in each other, twice as large each; volumes from the inside out."""
    start("nested boxes")
    for i in range(count):
        side = smallest * 2**i
        gmsh.model.occ.addBox(-side / 2, -side / 2, -side / 2, side, side, side)
    tags = [e for e in gmsh.model.occ.getEntities(3)]
    if count > 1:
        gmsh.model.occ.fragment(tags[:1], tags[1:])
    gmsh.model.occ.synchronize()
    return sorted(gmsh.model.getEntities(3), key=lambda e: gmsh.model.occ.getBoundingBox(*e)[3])


def single(make, name="single"):
    """One OpenCASCADE volume: `make(gmsh.model.occ)` returns its tag."""
    start(name)
    tag = make(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    return (3, tag)


def box(side=1.0):
    return single(lambda occ: occ.addBox(0, 0, 0, side, side, side), "box")


def two_boxes():
    """Two unit boxes beside each other, at x from 0 to 2; left, right, face between."""
    start("two boxes")
    occ = gmsh.model.occ
    occ.fragment([(3, occ.addBox(0, 0, 0, 1, 1, 1))], [(3, occ.addBox(1, 0, 0, 1, 1, 1))])
    occ.synchronize()
    left, right = sorted(gmsh.model.getEntities(3),
                         key=lambda e: occ.getCenterOfMass(*e)[0])
    between = (set(faces_of(left[1])) & set(faces_of(right[1]))).pop()
    return types.SimpleNamespace(left=left, right=right, between=between)


def box_in_box_of(shape, side=4.0):
    """A shape (made by `shape(occ)`, returning its tag) cut out of a box; its faces stay."""
    start("shape in box")
    occ = gmsh.model.occ
    block = occ.addBox(-side / 2, -side / 2, -side / 2, side, side, side)
    occ.cut([(3, block)], [(3, shape(occ))])
    occ.synchronize()
    volume = gmsh.model.getEntities(3)[0]
    half = side / 2 - 1e-6
    walls = []
    for face in faces_of(volume[1]):
        bounds = occ.getBoundingBox(*face)
        if max(abs(b) for b in bounds) > half:
            walls.append(face)
    return types.SimpleNamespace(volume=volume, walls=walls,
                                 faces=[f for f in faces_of(volume[1]) if f not in walls])


def square(side=1.0):
    """A plane square; `curves` bottom, right, top, left."""
    start("square")
    occ = gmsh.model.occ
    face = occ.addRectangle(0, 0, 0, side, side)
    occ.synchronize()
    def place(curve):
        x, y, _ = occ.getCenterOfMass(*curve)
        return (x / side, y / side)
    named = {place(c): c for c in boundary([(2, face)])}
    def at(x, y):
        return next(c for p, c in named.items() if abs(p[0] - x) + abs(p[1] - y) < 1e-6)
    return types.SimpleNamespace(face=(2, face), bottom=at(.5, 0), right=at(1, .5), top=at(.5, 1),
                                 left=at(0, .5))
