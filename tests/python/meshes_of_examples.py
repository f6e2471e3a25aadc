"""Element counts of mesh files, to compare what an example's forms have made."""

import gmsh


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
