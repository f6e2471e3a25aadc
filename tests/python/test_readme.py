"""README.md and docs/*.md: all that they tell users to type works, all that they name is there.

A block's fence names its language. Python, shell and .geo are run on a small model; `text` is what
the block before it prints, compared but for its numbers. A block of another kind is a failure, so
that what cannot be run here has to be listed under ELSEWHERE, with what runs it.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys

import gmsh
import pytest

import meshgrow

from document_blocks import DOCUMENTS, ROOT, anchors_of, blocks_of, inline_code_of, links_of
from program import PROGRAM

BLOCKS = [block for path in DOCUMENTS for block in blocks_of(path)]
INLINE = sorted({code for path in DOCUMENTS for code in inline_code_of(path)})

# Lines that cannot be run within a test: (file that runs them, what it says there).
ELSEWHERE = {
    "examples/run.sh": ("tests/python/test_examples.py", "def test_"),
    "tests/run.sh": ("tests/setup.sh", "Sourced by tests/run.sh"),
    "pip install .": ("tests/packaging/wheel.sh", "pip install ."),
    "sudo apt-get install": ("tests/setup.sh", "apt-get"),
    "cmake -S . -B build/install -DMESHGROW_BUILD_TESTS=OFF": ("tests/packaging/installed_package.sh",
                                                       "cmake --install"),
    "cmake --build build": ("tests/setup.sh", "cmake --build"),
    "cmake --install build": ("tests/packaging/installed_package.sh", "cmake --install"),
    "find_package(meshgrow": ("examples/cpp_project/CMakeLists.txt", "find_package(meshgrow"),
    "target_link_libraries(": ("examples/cpp_project/CMakeLists.txt", "target_link_libraries("),
}

SIZE_FUNCTIONS = ("fixed source Surface{7} attach Volume{1} size 0.1 growth 1.2 limit 2\n"
                  "mesh source Surface{7} attach Volume{2} growth 1.2 limit 2\n")
GEO = 'SetFactory("OpenCASCADE");\nMerge "model.step";\nCoherence;\ns = 7;\n'
# What blocks of Python take for granted: a model, one of whose faces has a mesh, and its field.
PYTHON = """
import gmsh, meshgrow
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.open("model.step")
gmsh.model.occ.removeAllDuplicates()
gmsh.model.occ.synchronize()
field = meshgrow.SizeField()
field.add_fixed([(2, 7)], [(2, 7)], size=0.1, growth_rate=1.2, size_limit=2.0)
field.generate(2)
field = meshgrow.SizeField()
field.add_mesh([(2, 7)], [(3, 2)], growth_rate=1.2, size_limit=2.0)
own_sizes = lambda dim, tag, x, y, z, *lc: 0.3
"""
# Where a block hands sizes to Gmsh: they are those of the function in volume 2.
MESHED_BY_THEM = """
gmsh.model.mesh.generate(3)
found = len(gmsh.model.mesh.getElements(3, 2)[1][0])
gmsh.model.mesh.removeSizeCallback()
field.unregister()
gmsh.model.mesh.clear()
gmsh.option.setNumber("Mesh.MeshSizeMax", 0.3)
gmsh.model.mesh.generate(3)
assert found > 1.2 * len(gmsh.model.mesh.getElements(3, 2)[1][0]), found
"""


def name_of(block):
    return "%s:%d" % (block.document, block.line)


# ==== Running ====


@pytest.fixture(scope="module")
def prepared(tmp_path_factory):
    """A folder with the files that the documents name, made once."""
    folder = tmp_path_factory.mktemp("model")
    write_model(folder / "model.step")
    (folder / "model.geo").write_text(GEO)
    (folder / "sizes.txt").write_text(SIZE_FUNCTIONS)
    for command in ("mesh model.geo -3 -o before.msh",
                    "field model.geo -2 -o sizes.mgf --size-functions sizes.txt",
                    "field model.geo -2 -o sizes.pos --size-functions sizes.txt"):
        run_shell(folder, "meshgrow " + command)
    return folder


def write_model(path):
    """Two hexagonal prisms; once they share it, Surface 7, at x = 1, is between them."""
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    occ = gmsh.model.occ
    corners = [(0.8, 0), (0.4, 0.7), (-0.4, 0.7), (-0.8, 0), (-0.4, -0.7), (0.4, -0.7)]
    points = [occ.addPoint(1, 0.5 + y, 0.5 + z) for y, z in corners]
    lines = [occ.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    for way in (-1, 1):
        occ.extrude([(2, face)], way, 0, 0)
    occ.synchronize()
    gmsh.write(str(path))
    gmsh.finalize()


@pytest.fixture
def folder(prepared, tmp_path):
    return shutil.copytree(prepared, tmp_path / "work")


def environment():
    places = [os.path.dirname(os.path.abspath(PROGRAM)), os.path.dirname(sys.executable),
              os.environ["PATH"]]
    return {**os.environ, "PATH": os.pathsep.join(places)}


def run(command, folder):
    result = subprocess.run(command, cwd=folder, env=environment(), capture_output=True, text=True,
                            timeout=300)
    assert result.returncode == 0, result.stdout[-2000:] + result.stderr[-2000:]
    return result.stdout


def run_shell(folder, text):
    return run(["bash", "-e", "-c", text], folder)


def run_python(folder, text):
    code = text if "gmsh.initialize" in text else PYTHON + text
    if "register()" in text or "setSizeCallback" in text:
        code += MESHED_BY_THEM
    return run([sys.executable, "-c", code], folder)


def run_geo(folder, text):
    (folder / "snippet.geo").write_text(GEO + text)
    if "Size functions/" in text:  # `meshgrow mesh` reads them, and plain Gmsh does not mind
        plan = run_shell(folder, "meshgrow mesh snippet.geo -3 --plan")
        assert "Mesh size function" in plan
        return plan
    run_shell(folder, "timeout 120 gmsh -v 2 snippet.geo -3 -o snippet.msh")
    shutil.copy(folder / "snippet.msh", folder / "grown.msh")
    assert tetrahedra(folder / "grown.msh") > 1.2 * tetrahedra(folder / "before.msh")
    return ""


def tetrahedra(path):
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(str(path))
    count = sum(len(tags) for tags in gmsh.model.mesh.getElements(3)[1])
    gmsh.finalize()
    return count


def run_cpp(folder, text):
    """Compiles it only; it stands in a function where `field` is a size field."""
    source = ("#include <functional>\n#include <meshgrow.hpp>\n"
              "void f(meshgrow::SizeField &field) {\n%s}\n")
    (folder / "snippet.cpp").write_text(source % text)
    return run(["g++", "-std=c++17", "-fsyntax-only", "-I", str(ROOT / "gmsh_plugin"),
                "snippet.cpp"], folder)


RUNNERS = {"python": run_python, "shell": run_shell, "geo": run_geo, "cpp": run_cpp}


def is_elsewhere(line):
    return all(any(part.startswith(start) for start in ELSEWHERE) for part in parts_of(line))


def parts_of(line):
    return [part.strip() for part in line.split("&&")]


def lines_to_run(block):
    """Its text without the lines that are run elsewhere."""
    lines = block.text.splitlines()
    if block.language in ("shell", "cmake"):
        lines = [line for line in lines if not is_elsewhere(line) and not line.startswith("#")]
    return "".join(line + "\n" for line in lines if line.strip())


@pytest.mark.parametrize("block", [b for b in BLOCKS if b.language != "text"], ids=name_of)
def test_a_block_runs(block, folder):
    assert block.language in {**RUNNERS, "cmake": None}, (
        "nothing runs this block: give its fence a language of %s" % ", ".join(RUNNERS))
    text = lines_to_run(block)
    if not text:
        return
    assert block.language in RUNNERS, "nothing runs these lines: list them under ELSEWHERE"
    output = RUNNERS[block.language](folder, text)
    index = BLOCKS.index(block)
    if index + 1 < len(BLOCKS) and BLOCKS[index + 1].language == "text":
        printed = {shape(line) for line in output.splitlines()}
        for line in BLOCKS[index + 1].text.splitlines():
            assert shape(line) in printed, "%r was not printed, but:\n%s" % (line, output)


def test_what_blocks_print_stands_after_a_block_that_runs():
    for before, block in zip([None] + BLOCKS, BLOCKS):
        assert block.language != "text" or before.language in RUNNERS, name_of(block)


def shape(line):
    """A line of output without its numbers and its spaces."""
    return " ".join(re.sub(r"\d[\d.,]*(e[-+]?\d+)?", "#", line).split())


@pytest.mark.parametrize("start", ELSEWHERE)
def test_what_cannot_be_run_here_is_run_elsewhere(start):
    path, text = ELSEWHERE[start]
    assert text in (ROOT / path).read_text()
    assert any(part.startswith(start) for block in BLOCKS for line in block.text.splitlines()
               for part in parts_of(line))


# ==== Names and links ====


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(path):
    for link in links_of(path):
        if re.match(r"https?:", link):
            continue
        target, _, anchor = link.partition("#")
        there = (path.parent / target).resolve() if target else path
        assert there.exists(), "%s leads nowhere" % link
        assert not anchor or anchor in anchors_of(there), "%s: there is no such heading" % link


PLACES = re.compile(r"^(?:examples|tests|src|gmsh_plugin|docs)/[\w./-]*[\w/]")


@pytest.mark.parametrize("code", [c for c in INLINE if PLACES.match(c) or " tests/" in c])
def test_files_that_are_named_exist(code):
    for word in shlex.split(code):
        if PLACES.match(word) and not word.startswith("examples/out"):
            assert (ROOT / word).exists(), "there is no %s" % word


@pytest.mark.parametrize("code", [c for c in INLINE if c.startswith("examples/run.sh ")])
def test_examples_that_are_named_exist(code):
    for name in code.split()[1:]:
        assert list((ROOT / "examples").glob(name + ".py")) + list(
            (ROOT / "examples").glob(name + ".geo")), "there is no example " + name
        assert name in (ROOT / "examples/run.sh").read_text()


def test_the_readme_lists_the_examples_that_run_sh_runs():
    script = (ROOT / "examples/run.sh").read_text()
    names = re.search(r"(?s)^all=\((.*?)\)", script, re.MULTILINE)[1].split()
    section = (ROOT / "README.md").read_text().split("\n## Examples\n")[1].split("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("| `")]
    listed = {name for row in rows for name in re.findall(r"`(\w+)`", row.split("|")[1])}
    assert not set(names) - listed, "README.md does not list these examples"
    assert not {name for name in listed if not list((ROOT / "examples").glob(name + ".*"))}


@pytest.mark.parametrize("code", [c for c in INLINE if re.match(r"build/bin/|ctest ", c)])
def test_programs_and_tests_that_are_named_are_built(code):
    name = code.split("/")[-1].split()[0] if code.startswith("build") else code.split()[-1]
    rules = "".join(path.read_text() for place in (ROOT / "tests", ROOT / "gmsh_plugin")
                    for path in place.rglob("CMakeLists.txt"))
    assert name in rules, "nothing builds " + name


@pytest.mark.parametrize("name", sorted({n for c in INLINE for n in
                                         re.findall(r"\bMESHGROW_[A-Z_]+", c)}))
def test_variables_of_the_environment_are_read(name):
    files = [path for place in ("gmsh_plugin", "src", "examples", "tests")
             for path in (ROOT / place).rglob("*") if path.suffix in (".cpp", ".py", ".sh", ".h")]
    assert any(name in path.read_text() for path in files if path != ROOT / __file__)


@pytest.mark.parametrize("option", sorted({o for c in INLINE for o in
                                           re.findall(r"(?<!\S)--[a-z][\w-]+", c)}))
def test_options_are_taken_by_a_program(option):
    helps = "".join(subprocess.run([PROGRAM, command, "--help"], capture_output=True,
                                   text=True).stdout
                    for command in ("mesh", "report", "probe", "field", "serve"))
    scripts = [*(ROOT / "examples").glob("*.py"), *(ROOT / "tests").glob("*.sh"),
               *(ROOT / "tests/benchmarks").glob("*.py")]
    assert option in helps + "--version" or any(option in path.read_text() for path in scripts)


@pytest.mark.parametrize("name", sorted({n for c in INLINE for n in
                                         re.findall(r"\bfield\.(\w+)\(", c)}))
def test_methods_that_are_named_exist(name):
    assert hasattr(meshgrow.SizeField, name)
