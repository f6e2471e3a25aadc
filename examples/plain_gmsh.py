"""The smallest script: a plate with a hole, fine at the hole, growing from there.

    python examples/plain_gmsh.py          # any gmsh from 4.8 on, and meshgrow
"""

import os
import sys

import gmsh
import meshgrow


def main(path="plain_gmsh.msh"):
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Verbosity", 2)
    occ = gmsh.model.occ
    (plate,), _ = occ.cut([(3, occ.addBox(-2, -1, 0, 4, 2, 0.4))],
                          [(3, occ.addCylinder(0, 0, 0, 0, 0, 0.4, 0.3))])
    occ.synchronize()
    hole = [face for face in gmsh.model.getBoundary([plate], oriented=False)
            if gmsh.model.getType(*face) == "Cylinder"]

    field = meshgrow.SizeField()
    field.add_fixed(sources=hole, attach=[plate], size=0.06, growth_rate=1.2, size_limit=0.4)
    field.generate(3)

    report = meshgrow.report(3, [plate], field)
    print(meshgrow.report_table({"plate": report}))
    gmsh.write(path)
    gmsh.finalize()
    return report


if __name__ == "__main__":
    main(os.path.join(os.environ.get("MESHGROW_EXAMPLES_OUT", "."), "plain_gmsh.msh")
         if len(sys.argv) < 2 else sys.argv[1])
