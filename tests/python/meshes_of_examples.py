"""Element counts of mesh files, to compare what an example's forms have made."""

import os

import gmsh
import pytest

from program import PROGRAM


def elements_by_entity(path, dim):
    """{(tag, element type): number of elements} of the entities of a dimension."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.open(str(path))
    counts = {(tag, kind): len(elements)
              for _, tag in gmsh.model.getEntities(dim)
              for kind, elements in zip(*gmsh.model.mesh.getElements(dim, tag)[:2])}
    gmsh.finalize()
    return counts


def built_example(name):
    """Path of an example in C++, built for the Gmsh of this process."""
    generation = "debian" if gmsh.__version__.startswith("4.8") else "newest"
    path = os.path.join(os.path.dirname(PROGRAM), "examples", "%s_%s" % (name, generation))
    if not os.path.exists(path):
        pytest.skip("examples/%s.cpp is not built" % name)
    return path
