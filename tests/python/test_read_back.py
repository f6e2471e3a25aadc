"""Meshes that come back from files or from earlier runs."""

import gmsh
import meshgrow
import pytest

from meshes import has_elements


def test_the_surface_of_a_stretched_sphere_is_kept():
    # The box that Gmsh tells of its poles is where they were before stretching.
    occ = gmsh.model.occ
    sphere = (3, occ.addSphere(0, 0, 0, 1))
    occ.dilate([sphere], 0, 0, 0, 8, 5, 5)
    occ.fragment([(3, occ.addBox(-11, -6.5, -6.5, 19.6, 13, 13))], [sphere])
    occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", 2)
    meshgrow.SizeField().generate(3)
    gmsh.model.mesh.clear([sphere])
    assert not has_elements(sphere)
    meshgrow.SizeField().generate(3)
    assert has_elements(sphere)


def test_a_volume_without_geometry_is_named(tmp_path):
    path = str(tmp_path / "box.msh")
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(3)
    gmsh.write(path)
    gmsh.clear()
    gmsh.merge(path)
    gmsh.model.mesh.clear([(3, 1)])
    field = meshgrow.SizeField()
    field.add_mesh(gmsh.model.getEntities(2), [(3, 1)], growth_rate=1.2, size_limit=1)
    with pytest.raises(meshgrow.Error, match="^Volume 1 came with a mesh and has no geometry"):
        field.generate(3)
