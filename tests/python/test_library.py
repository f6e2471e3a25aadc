"""One shared library for every Gmsh, found at run time."""

import ctypes
import os
import shutil
import subprocess

import meshgrow
import pytest

import program
from child import run_child
from meshgrow import _library

LIBRARY = _library._find_library()
FAKE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fake_gmsh.c")
CREATE = """
import ctypes
library = ctypes.CDLL(%r)
library.meshgrow_field_create.restype = ctypes.c_void_p
library.meshgrow_last_error.restype = ctypes.c_char_p
print(library.meshgrow_field_create())
print(library.meshgrow_last_error().decode())
""" % LIBRARY


def error_with(path):
    """What creating a field says when MESHGROW_GMSH_LIB names this libgmsh."""
    created, *sentence = run_child(CREATE, MESHGROW_GMSH_LIB=str(path))
    assert created == "None"
    assert len(sentence) == 1 and sentence[0].endswith(".")
    return sentence[0]


@pytest.fixture
def fake_gmsh(tmp_path):
    """Builds a library that says it is a Gmsh of some version."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")

    def build(version, *more):
        path = tmp_path / "libgmsh_fake.so"
        subprocess.run([compiler, "-shared", "-fPIC", '-DVERSION="%s"' % version, *more, "-o",
                        str(path), FAKE], check=True)
        return path
    return build


@pytest.mark.skipif(shutil.which("ldd") is None, reason="no ldd")
def test_library_is_not_linked_to_libgmsh():
    told = subprocess.run(["ldd", LIBRARY], stdout=subprocess.PIPE, text=True, check=True).stdout
    assert "libstdc++" in told
    assert "gmsh" not in told.replace(LIBRARY, "")


def test_a_libgmsh_that_is_missing_is_told_with_the_variable_that_names_it(tmp_path):
    sentence = error_with(tmp_path / "libgmsh_missing.so")
    assert "MESHGROW_GMSH_LIB" in sentence
    assert "libgmsh_missing.so" in sentence


def test_a_file_that_is_no_library_is_told(tmp_path):
    path = tmp_path / "libgmsh_text.so"
    path.write_text("no library")
    assert "libgmsh_text.so" in error_with(path)


@pytest.mark.parametrize("version", ["4.7.1", "3.0.6", "2.16"])
def test_a_libgmsh_that_is_too_old_is_told_with_its_version(fake_gmsh, version):
    path = fake_gmsh(version)
    sentence = error_with(path)
    assert version in sentence
    assert str(path) in sentence
    assert "4.8" in sentence


def test_a_libgmsh_that_tells_no_version_is_told(fake_gmsh):
    assert "no version" in error_with(fake_gmsh("unknown"))


def test_a_libgmsh_that_lacks_a_function_is_told_with_the_functions_name(fake_gmsh):
    assert "gmshModelGetEntities" in error_with(fake_gmsh("4.12.2"))


def test_a_libgmsh_that_is_not_initialized_is_told(fake_gmsh):
    assert "gmsh.initialize()" in error_with(fake_gmsh("4.12.2", "-DNOT_INITIALIZED"))


def test_a_failure_can_be_mended_in_the_same_process(fake_gmsh):
    """The variable is read again at the next call."""
    lines = run_child(CREATE + "import os\n"
                      "os.environ['MESHGROW_GMSH_LIB'] = %r\n"
                      "library.meshgrow_field_create()\n"
                      "print(library.meshgrow_last_error().decode())\n"
                      % str(fake_gmsh("4.7.1")), MESHGROW_GMSH_LIB="/nowhere/libgmsh.so")
    assert "/nowhere" in lines[1]
    assert "4.7.1" in lines[2]


def test_the_loaded_gmsh_is_used_whatever_the_variable_names():
    lines = run_child("import gmsh, meshgrow, models\n"
                      "gmsh.initialize(readConfigFiles=False)\n"
                      "gmsh.option.setNumber('General.Terminal', 0)\n"
                      "models.square()\n"
                      "print(meshgrow.SizeField().statistics()['groups'])\n",
                      MESHGROW_GMSH_LIB="/nowhere/libgmsh.so")
    assert lines == ["[]"]


def test_package_can_be_imported_without_gmsh():
    assert run_child("import sys, meshgrow; print('gmsh' in sys.modules, meshgrow.__version__)") \
        == ["False %s" % meshgrow.__version__]


def test_a_missing_libmeshgrow_is_told_with_the_paths_looked_at():
    lines = run_child("try:\n"
                      "    import meshgrow\n"
                      "except ImportError as error:\n"
                      "    print(error)\n", MESHGROW_LIB="/nowhere/libmeshgrow.so")
    assert len(lines) == 1 and "/nowhere/libmeshgrow.so" in lines[0]


def test_every_function_of_the_header_is_exported_and_known_to_the_package():
    header = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "gmsh_plugin",
                          "meshgrow.h")
    with open(header) as file:
        text = file.read()
    declared = set()
    for part in text.split("MESHGROW_API ")[1:]:
        name = part.split("(")[0].split()
        if name and name[-1].startswith("meshgrow_"):
            declared.add(name[-1])
    library = ctypes.CDLL(LIBRARY)
    assert len(declared) > 15
    assert [name for name in sorted(declared) if not hasattr(library, name)] == []
    assert sorted(set(_library._SIGNATURES) - declared) == []


def test_calls_without_a_field_say_so():
    assert _library.lib.meshgrow_field_generate(None, 3, 0) == 1
    assert "size field" in _library.lib.meshgrow_last_error().decode()
    assert _library.lib.meshgrow_field_register(None) == 1
    _library.lib.meshgrow_field_destroy(None)
    _library.lib.meshgrow_free(None)


MODEL_AND_WARNINGS = """
import gmsh, meshgrow, models
gmsh.initialize(readConfigFiles=False)
gmsh.option.setNumber("General.Terminal", 0)
models.square()
gmsh.logger.start()
meshgrow.SizeField(), meshgrow.SizeField()
print([m for m in gmsh.logger.get() if "MESHGROW_SIMD" in m])
"""


def test_instructions_that_the_processor_lacks_are_told_once():
    (told,) = run_child(MODEL_AND_WARNINGS, MESHGROW_SIMD="mmx")
    assert told.count("Warning: ") == 1 and 'MESHGROW_SIMD is "mmx"' in told
    for value in ("plain", ""):
        assert run_child(MODEL_AND_WARNINGS, MESHGROW_SIMD=value) == ["[]"]


def test_they_are_told_without_a_gmsh_too(tmp_path):
    box = tmp_path / "box.geo"
    box.write_text('SetFactory("OpenCASCADE");\nBox(1) = {0, 0, 0, 1, 1, 1};\n')
    saved = tmp_path / "a.mgf"
    assert program.run("field", box, "-o", saved, "--size-function",
                       "fixed source Point{1} attach Volume{1} size 0.2 growth 1.2 limit 0.5"
                       ).returncode == 0
    result = program.run("probe", saved, "--at", "0,0,0", MESHGROW_SIMD="mmx",
                         MESHGROW_GMSH_LIB="/nowhere/libgmsh.so")
    assert result.returncode == 0
    assert 'MESHGROW_SIMD is "mmx"' in result.stderr
