"""What the tests of kinds of entities share."""

import gmsh
import meshgrow
import numpy as np
import pytest

import models
from meshes import corner_tags, quad_corners


def grow(sources, attach, dim=3, growth_rate=1.5, size_limit=0.5):
    field = meshgrow.SizeField()
    field.add_mesh(sources, attach, growth_rate, size_limit)
    field.generate(dim)


def grow_fixed(sources, attach, size=0.2, dim=3):
    field = meshgrow.SizeField()
    field.add_fixed(sources, attach, size, 1.5, 0.5)
    field.generate(dim)


def coordinates(entity):
    return np.reshape(gmsh.model.mesh.getNodes(*entity)[1], (-1, 3))


def face_at(volume, axis, value):
    return next(f for f in models.faces_of(volume[1])
                if abs(gmsh.model.occ.getCenterOfMass(*f)[axis] - value) < 1e-6)


def quads_in(*surfaces):
    return sum(len(quad_corners(f)) for f in surfaces)


def triangles_in(*surfaces):
    return sum(len(corner_tags(f, "Triangle")) for f in surfaces)
