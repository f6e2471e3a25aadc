"""Names and paths with spaces, quotes and letters of all the world, and groups without entities."""

import json
import shlex
import shutil

import gmsh
import meshgrow
import pytest

import models
from meshes import premesh
from program import run

NAME = "größe 'maß' 寸法"
MODEL = """
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Physical Surface("Flügel links; außen 翼") = {1};
Physical Volume("Luft ringsum") = {1};
Mesh.MeshSizeMax = 0.5;
Mesh.SaveAll = 1;
"""
FUNCTION = ('fixed source Physical Surface{"Flügel links; außen 翼"} '
            'attach Physical Volume{Luft ringsum} size 0.1 growth 1.3 limit 0.5 name "Größe 1"')


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / NAME
    path.mkdir()
    return path


@pytest.fixture
def model(folder):
    path = folder / (NAME + ".geo")
    path.write_text(MODEL)
    return path


def done(*arguments):
    result = run(*arguments)
    assert result.returncode == 0, result.stderr
    return result.stdout


def shown(text, program):
    """The file of a line "To look at it: ...", as a shell takes it."""
    line = next(x for x in text.splitlines() if "To look at it: %s " % program in x)
    words = shlex.split(line.split("To look at it: ")[1])
    assert words[0] == program and len(words) == 2, line
    return words[1]


def test_the_program_takes_any_name_for_each_of_its_files(folder, model):
    functions, mesh, report = folder / "größen.txt", folder / "netz a.msh", folder / "b ü.json"
    functions.write_text(FUNCTION + "\n")
    text = done("mesh", model, "-3", "-o", mesh, "--size-functions", functions, "--report", report)
    assert shown(text, "gmsh") == str(mesh)
    assert 'Fixed size function "Größe 1"' in text
    assert json.loads(report.read_text())[0]["name"] == mesh.name
    saved = folder / "feld 1 ß.mgf"
    text = done("field", model, "-o", saved, "--size-functions", functions)
    line = next(x for x in text.splitlines() if "SizeField.load" in x)
    assert eval(line.split("SizeField.load(")[1][:-1]) == str(saved)
    for ending, program in ((".vtu", "paraview"), (".pos", "gmsh"), (".msh", "gmsh")):
        view = folder / ("feld 1 ß" + ending)
        assert shown(done("field", saved, "-o", view), program) == str(view)
        assert view.stat().st_size > 1000
    assert str(mesh) in done("report", mesh, "--sizes", saved)
    rows = json.loads(done("report", mesh, "--json"))
    assert rows[0]["name"] == str(mesh) and rows[0]["report"]["elements"] > 10
    probes = json.loads(done("probe", saved, "--at", "0.5,0.5,0.5", "--json"))
    assert probes[0]["function"]["name"] == "Größe 1"
    served = run("serve", saved)
    assert served.returncode == 0


def test_a_view_has_the_name_of_its_file(folder, model):
    for name in ('with "quotes".pos', "mit Maß ß.pos", 'with "quotes".msh'):
        done("field", model, "-o", folder / name, "--size-function", FUNCTION)
        gmsh.clear()
        gmsh.merge(str(folder / name))
        assert len(gmsh.view.getTags()) == 1
        gmsh.view.remove(gmsh.view.getTags()[0])


def test_bytes_that_are_no_text_are_replaced_in_reports(folder, model):
    """A name of a file may have any bytes."""
    done("mesh", model, "-2", "-o", folder / "a.msh")
    odd = bytes(folder / "caf") + b"\xe9.msh"
    shutil.copy(folder / "a.msh", odd)
    for arguments in (["--json"], []):
        assert "caf\N{REPLACEMENT CHARACTER}.msh" in done(
            "report", odd.decode(errors="surrogateescape"), "--dim", 2, *arguments)


def test_python_takes_any_name(folder, model):
    gmsh.open(str(model))
    field = meshgrow.SizeField(evaluator="grid")
    field.add(FUNCTION)
    field.add_fixed([(0, 1)], [(3, 1)], 0.2, 1.2, 0.5, name="zweite ß")
    assert list(field.functions()) == ["Größe 1", "zweite ß"]
    field.save(folder / "feld ß.mgf")
    loaded = meshgrow.SizeField.load(folder / "feld ß.mgf")
    assert loaded.functions() == field.functions()
    assert "Größe 1" in loaded.summary()
    for ending in (".vtu", ".pos", ".msh"):
        assert field.write_view(folder / ("feld ß" + ending)) > 0
    with pytest.raises(meshgrow.Error, match="fehlt ß.mgf"):
        meshgrow.SizeField.load(folder / "fehlt ß.mgf")
    with pytest.raises(meshgrow.Error, match="nichts ß"):
        field.add(FUNCTION.replace("Luft ringsum", "nichts ß"))
    tag = field.add_view("Ansicht ß 図")
    assert gmsh.option.getString("View[%d].Name" % gmsh.view.getIndex(tag)) == "Ansicht ß 図"


def test_models_of_any_name_have_fields():
    for name in ("", "mit Leerraum ß", "a\"b'c"):
        gmsh.model.add(name)
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        field = meshgrow.SizeField()
        field.add_fixed([(0, 1)], [(3, 1)], 0.2, 1.2, 0.5)
        assert field.size(3, 1, [[0.5, 0.5, 0.5]])[0] < 0.5


# ==== Physical groups without entities


def test_a_group_without_entities_is_named():
    """The surface of a group was removed; Gmsh may keep the name."""
    model = models.two_boxes()
    premesh([model.between], 0.3)
    group = gmsh.model.addPhysicalGroup(2, [model.between[1]])
    gmsh.model.setPhysicalName(2, group, "mur mitoyen é")
    empty = gmsh.model.addPhysicalGroup(2, [])
    gmsh.model.setPhysicalName(2, empty, "nobody")
    field = meshgrow.SizeField()
    text = "mesh source Physical Surface{%s} attach Volume{%d} growth 1.2 limit 1"
    field.add(text % ('"mur mitoyen é"', model.right[1]))
    for name in ("nobody", '"nobody"', str(empty)):
        with pytest.raises(meshgrow.Error) as refused:
            field.add(text % (name, model.right[1]))
        sentence = str(refused.value)
        assert name.strip('"') in sentence and sentence.endswith(".") and "\n" not in sentence
    assert len(field.functions()) == 1
