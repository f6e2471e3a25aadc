"""Volumes that grow from a face mesh out of a file: its nodes stay, and sizes grow from it."""

import os
import shutil

import gmsh
import meshgrow

import program
from example_fixture import EXAMPLES, example  # noqa: F401

READS_NEU = tuple(map(int, gmsh.__version__.split(".")[:2])) >= (4, 12)


def test_volumes_grow_from_imported_faces_whose_nodes_stay(example, tmp_path):
    module = example("imported_face")
    rows = module.main()
    read = {variant.split()[-1] for shape, variant in rows if shape == "bounded"} - {"without"}
    assert read >= {".msh", ".stl", ".unv"}
    assert (".neu" in read) == READS_NEU
    for (shape, variant), row in rows.items():
        assert row["moved"] == 0 and row["same_triangles"]
        assert row["imported"] > 100
        if variant != "without":
            without = rows[shape, "without"]
            assert row["ratio_99"] <= 1.33
            assert without["ratio_99"] > row["ratio_99"] + 0.1
            assert row["length_share_over_2"] <= 0.01
            assert without["length_share_over_2"] > 0.15
            assert row["largest_asked"] < module.SIZE_LIMIT / 2  # never reached
    assert (tmp_path / "imported_face_swept_with_stl.msh").exists()

    # The same in .geo, from the file that the example has written.
    shutil.copy(os.path.join(EXAMPLES, "imported_face.geo"), tmp_path)
    result = program.run("mesh", tmp_path / "imported_face.geo", "-3", "--calibrate",
                         "-o", tmp_path / "geo.msh")
    assert result.returncode == 0, result.stderr
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(str(tmp_path / "geo.msh"))
    elements = meshgrow.report(3)["elements"]
    gmsh.finalize()
    assert elements == rows["bounded", "with .msh"]["elements"]
