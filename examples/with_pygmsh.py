"""A model made with pygmsh (https://github.com/nschloe/pygmsh), sizes by meshgrow.

    pip install pygmsh gmsh meshgrow
    python examples/with_pygmsh.py

pygmsh makes the geometry in Gmsh's current model, and there meshgrow finds it: mesh with
`field.generate` in place of `geometry.generate_mesh`.
"""

import os
import sys

import gmsh
import meshgrow
import pygmsh


def main(path="with_pygmsh.msh"):
    with pygmsh.occ.Geometry() as geometry:
        gmsh.option.setNumber("General.Verbosity", 2)
        block = geometry.add_box([-2, -2, -2], [4, 4, 4])
        ball = geometry.add_ball([0.5, 0, 0], 0.8)
        block = geometry.boolean_difference(block, ball)[0]
        geometry.synchronize()
        faces = gmsh.model.getBoundary([block.dim_tag], oriented=False)
        sphere = [face for face in faces if gmsh.model.getType(*face) == "Sphere"]

        field = meshgrow.SizeField()
        field.add_curvature(sphere, [block.dim_tag], angle=12, growth_rate=1.2, size_limit=0.6)
        field.generate(3)

        report = meshgrow.report(3, [block.dim_tag], field)
        print(meshgrow.report_table({"block": report}))
        gmsh.write(path)
        return report


if __name__ == "__main__":
    main(os.path.join(os.environ.get("MESHGROW_EXAMPLES_OUT", "."), "with_pygmsh.msh")
         if len(sys.argv) < 2 else sys.argv[1])
