"""What growth rates give: how far and through how many layers sizes grow, and how many elements.

    PYTHONPATH=build/python python3 tests/benchmarks/growth_rates.py        a Markdown table

A cube of side 4 grows from one face, meshed by triangles of size 0.05, to the limit 0.5,
calibrated, by 3D Delaunay. Tetrahedra are counted in all and for each triangle of the face.
"""

import gmsh
import meshgrow

SIZE, LIMIT, SIDE = 0.05, 0.5, 4.0
GROWTH_RATES = (1.1, 1.2, 1.3, 1.5, 2.0)


def mesh(growth_rate):
    """(triangles of the face, report of the cube)."""
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    volume = (3, gmsh.model.occ.addBox(0, 0, 0, SIDE, SIDE, SIDE))
    gmsh.model.occ.synchronize()
    face = (2, 5)  # the lower one
    field = meshgrow.SizeField(calibrate=True)
    field.add_fixed([face], [volume], SIZE, growth_rate, LIMIT)
    field.generate(3)
    triangles = len(gmsh.model.mesh.getElements(*face)[1][0])
    result = triangles, meshgrow.report(3, [volume], field)
    gmsh.finalize()
    return result


def layers(growth_rate):
    """Layers until the limit, and the distance at which it is reached."""
    count, size = 0, SIZE
    while size < LIMIT:
        count, size = count + 1, size * growth_rate
    return count, (LIMIT - SIZE) / (1 - 1 / growth_rate)


def main():
    print("| growth rate | layers | distance | tetrahedra | for each triangle | ratio, 99 % |")
    print("| --- | --- | --- | --- | --- | --- |")
    for growth_rate in GROWTH_RATES:
        triangles, report = mesh(growth_rate)
        print("| %g | %d | %.2f | %s | %.0f | %.2f |" % (
            growth_rate, *layers(growth_rate), "{:,}".format(report["elements"]),
            report["elements"] / triangles, report["ratio_99"]), flush=True)


if __name__ == "__main__":
    main()
