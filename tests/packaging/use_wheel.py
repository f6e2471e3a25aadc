"""Uses the package as it is installed into the environment of the Python that runs this."""

import inspect
import os
import subprocess
import sys
import tempfile

import gmsh
import meshgrow
import numpy as np
from meshgrow import _library

INSTALLED = os.path.join(sys.prefix, "lib")


def sphere_in_box():
    gmsh.model.add("sphere in box")
    occ = gmsh.model.occ
    sphere = occ.addSphere(0, 0, 0, 1)
    box = occ.addBox(-2, -2, -2, 4, 4, 4)
    _, (pieces, (inner,)) = occ.fragment([(3, box)], [(3, sphere)])
    occ.synchronize()
    outer, = set(pieces) - {inner}
    return outer, gmsh.model.getBoundary([inner], oriented=False)


def check_meshing():
    outer, faces = sphere_in_box()
    field = meshgrow.SizeField()
    field.add_fixed(sources=faces, attach=[(3, 1), (3, 2)], size=0.2, growth_rate=1.3,
                    size_limit=0.6)
    field.generate(3)
    report = meshgrow.report(3, [outer], field)
    assert report["elements"] > 1000 and report["ratio_99"] < 1.6, report
    points = np.random.default_rng(1).uniform(-2, 2, (1000, 3))
    sizes = np.empty(1000)
    assert field.size(*outer, points, out=sizes) is sizes
    assert sizes.min() >= 0.2 / 1.06 and sizes.max() <= 0.6 * 1.06
    print(meshgrow.report_table({"outer": report}), end="")


def check_annotations():
    """Everything public says what it takes and gives."""
    functions = [meshgrow.report, meshgrow.report_table]
    functions += [f for name, f in inspect.getmembers(meshgrow.SizeField, inspect.isfunction)
                  if not name.startswith("_") or name in ("__init__", "__call__")]
    for function in functions:
        signature = inspect.signature(function)
        given = [p.annotation for p in signature.parameters.values() if p.name != "self"]
        assert inspect.Parameter.empty not in given + [signature.return_annotation], function
        assert function.__doc__ or function.__name__ == "__init__", function


def check_program(gmsh_version):
    """The program works, with the Gmsh of this Python."""
    program = os.path.join(os.path.dirname(sys.executable), "meshgrow")
    with tempfile.TemporaryDirectory() as folder:
        model, mesh = os.path.join(folder, "box.geo"), os.path.join(folder, "box.msh")
        with open(model, "w") as file:
            file.write('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 1, 1, 1};\n')
        told = subprocess.run(
            [program, "mesh", model, "-3", "-o", mesh, "-v", "4", "--size-function",
             "fixed source Surface{1} attach Volume{1} size 0.1 growth 1.3 limit 0.5"],
            check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True).stdout
        assert os.path.getsize(mesh) > 10000, told
    version = subprocess.run([program, "--version"], check=True, stdout=subprocess.PIPE, text=True)
    expected = "meshgrow %s with Gmsh %s" % (meshgrow.__version__, gmsh_version)
    assert version.stdout.startswith(expected), version.stdout


def main():
    assert _library._find_library().startswith(INSTALLED), _library._find_library()
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh_version = gmsh.option.getString("General.Version")
    print("meshgrow %s with Gmsh %s" % (meshgrow.__version__, gmsh_version))
    check_meshing()
    check_annotations()
    gmsh.finalize()
    check_program(gmsh_version)


if __name__ == "__main__":
    main()
