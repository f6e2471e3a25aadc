"""Two faces: the cases for the page, and the same meshes by the .geo and the C++ program."""

import json
import os
import subprocess

from example_fixture import EXAMPLES, example  # noqa: F401
from meshes_of_examples import built_example, elements_by_entity
from program import PROGRAM


def make_with_variants(module):
    """The meshes with a mesh size function; {(source, right face): path}."""
    module.main()
    return {(source, right_face): module.tools.OUT + "/two_faces_%s_%s_with.msh" % (
        source.split()[-1], right_face)
            for source in module.SOURCES for right_face in module.RIGHT_FACES}


def test_sizes_of_the_left_face_alone_jump_in_the_right_face(example):
    module = example("two_faces")
    rows = module.main()
    for source in module.SOURCES:
        for right_face in module.RIGHT_FACES:
            of = {name: rows[source, right_face, name] for name in module.VARIANTS}
            before = of[module.BEFORE[right_face]]
            assert of["with"]["right_99"] < before["right_99"] - 0.1
            assert of["with"]["across_max"] < before["across_max"] - 0.25
            assert of["with"]["right_long"] == 0 < before["right_long"]


def test_each_case_tells_the_page_its_lines_and_numbers(example, tmp_path):
    module = example("two_faces")
    rows = module.main()
    for source in module.SOURCES:
        for right_face in module.RIGHT_FACES:
            name = "two_faces.%s_%s.case.json" % (source.split()[-1], right_face)
            case = json.loads((tmp_path / name).read_text())
            assert [len(one["lines"]) for one in case["variants"]] == [1, 2, 2]
            for variant in case["variants"]:
                row = rows[source, right_face, variant["name"]]
                assert variant["report"]["elements"] == row["right_elements"]
                assert (tmp_path / variant["mesh"]).exists()


def test_the_geo_gives_the_same_elements(example, tmp_path):
    for (source, right_face), path in make_with_variants(example("two_faces")).items():
        made = str(tmp_path / "by_geo.msh")
        subprocess.run(
            [PROGRAM, "mesh", os.path.join(EXAMPLES, "two_faces.geo"), "-2", "-o", made,
             "-setnumber", "from_vertex", str(int(source == "upper left vertex")),
             "-setnumber", "right_face", str(("triangles", "quads", "mapped").index(right_face))],
            check=True, capture_output=True)
        assert elements_by_entity(made, 2) == elements_by_entity(path, 2)


def test_the_cpp_program_gives_the_same_elements(example, tmp_path):
    program = built_example("two_faces")
    for (source, right_face), path in make_with_variants(example("two_faces")).items():
        made = str(tmp_path / "by_cpp.msh")
        subprocess.run([program, made, source.split()[-1], right_face], check=True,
                       capture_output=True)
        assert elements_by_entity(made, 2) == elements_by_entity(path, 2)
