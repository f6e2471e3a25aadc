"""The page of the examples: made of small cases, and opened in Chromium."""

import importlib
import json
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import gmsh
import meshgrow
import pytest

import chromium
from example_fixture import EXAMPLES

ODD_TITLE = 'Sizes <b>0.1</b> & "0.3", 100 % of Ä\'s {{ 7 * 7 }}'
VOID_ELEMENTS = {"meta", "link", "img", "base", "wbr", "br"}


# Not at the head of the file: there, pytest would call a file without any test an error.
@pytest.fixture(autouse=True)
def modules_of_the_page():
    pytest.importorskip("jinja2")
    pytest.importorskip("matplotlib")


@pytest.fixture
def cases(tmp_path, monkeypatch):
    """The module page.cases, writing into a folder with a space in its name."""
    out = tmp_path / "what comes out"
    out.mkdir()
    monkeypatch.setenv("MESHGROW_EXAMPLES_OUT", str(out))
    monkeypatch.delenv("MESHGROW_EXAMPLES_PICTURES", raising=False)
    monkeypatch.syspath_prepend(EXAMPLES)
    sys.modules.pop("page.cases", None)
    return importlib.import_module("page.cases")


def make_page(cases):
    program = os.path.join(EXAMPLES, "page", "make_page.py")
    return subprocess.run([sys.executable, program, cases.OUT],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8")


def page_of(cases):
    made = make_page(cases)
    assert made.returncode == 0, made.stderr
    path = Path(cases.OUT, "index.html")
    assert str(path) in made.stdout
    return path


def mesh_box(cases, case, dim, name, size):
    """Adds a mesh of a square or a box to the case, made with a field."""
    gmsh.model.add(name)
    if dim == 2:
        gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    else:
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    field = meshgrow.SizeField()
    field.add_fixed(sources=[(dim - 1, 1)], attach=[(dim, 1)], size=size, growth_rate=1.2,
                    size_limit=0.3)
    field.generate(dim)
    path = os.path.join(cases.OUT, "%s.%dd.msh" % (name, dim))
    gmsh.write(path)
    case.add(name, "%s: %g & <more>" % (name, size), path, meshgrow.report(dim, [], field), field,
             facts={"start size": size})
    gmsh.model.remove()


@pytest.fixture
def page(cases):
    """Path of a page of a flat and a solid case, with all kinds of pictures."""
    flat = cases.Case("late_example", "square", title=ODD_TITLE, about="A square.",
                      premeshed="one side", measured="the surface", figures="Figure 11")
    solid = cases.Case("early_example", "box", title="A box", about="A box.", premeshed="one face",
                       measured="the volume", figures="Figures 9 and 2")
    for case, dim in ((flat, 2), (solid, 3)):
        for name, size in (("before", 0.3), ("after", 0.1)):
            mesh_box(cases, case, dim, name, size)
        case.draw("surface", "before", "after", "--dim", "2", caption="Seen from the front.")
        if dim == 3:
            case.draw("cut", "before", "after", "--plane", "0,0.5,0,0,-1,0", "--view", "iso")
        case.draw_histogram("before", "after", dim)
        for picture in case.save():
            assert os.path.getsize(picture) > 5000
    return page_of(cases)


def test_the_page_shows_all_and_the_check_finds_what_is_broken(page, tmp_path):
    found = chromium.look_at(page, tmp_path / "whole")
    assert chromium.faults(found) == []
    assert found["pictures"] == 2 + 5  # thumbnails and pictures
    for words in (ODD_TITLE, "A box", "before: 0.3 & <more>", "Figures 9 and 2", "one face",
                  "fixed source Surface{1} attach Volume{1} size 0.1 growth 1.2 limit 0.3",
                  "Seen from the front."):
        assert words in found["text"]
    # In the order of the figures.
    assert found["text"].index("early_example\n") < found["text"].index("late_example\n")
    assert set(links_to_files(page)) >= {"before.3d.msh", "early_example.box_cut.png"}
    for name in links_to_files(page):
        assert (page.parent / name).exists(), name

    # A picture that is not there, and one that is damaged.
    cut = page.parent / "early_example.box_cut.png"
    cut.unlink()
    surface = page.parent / "late_example.square_surface.png"
    surface.write_bytes(b"no picture")
    found = chromium.look_at(page, tmp_path / "without a picture")
    assert set(found["broken_pictures"]) == {cut.name, surface.name}
    assert "broken picture: " + cut.name in chromium.faults(found)


@pytest.mark.parametrize("script, complaint", [
    ("throw new Error('thrown early')", "thrown early"),
    ("setTimeout(() => undefinedFunction(), 10)", "undefinedFunction"),
    ("Promise.reject(new Error('refused'))", "refused"),
    ("syntax error here", "Unexpected identifier"),
])
def test_the_check_finds_errors_of_scripts(cases, tmp_path, script, complaint):
    page = page_of(cases)
    page.write_text(page.read_text(encoding="utf-8").replace(
        "</body>", "<script>%s</script></body>" % script), encoding="utf-8")
    found = chromium.look_at(page, tmp_path / "throwing")
    assert any(complaint in text for text in found["script_errors"])


def test_an_example_makes_a_page_without_faults(cases, tmp_path, monkeypatch):
    monkeypatch.setenv("MESHGROW_EXAMPLES_COARSE", "2")
    for module in ("example_tools", "crack"):
        sys.modules.pop(module, None)
    importlib.import_module("crack").main()
    found = chromium.look_at(page_of(cases), tmp_path / "of the crack")
    assert chromium.faults(found) == []
    kinds = {re.split(r"[_.]", path.name)[2].rstrip("2") for path in Path(cases.OUT).glob("*.png")}
    assert kinds == {"surface", "cut", "histogram"}


def test_the_check_finds_dead_links(cases, tmp_path):
    page = page_of(cases)
    page.write_text(page.read_text(encoding="utf-8").replace(
        "</body>", '<a href="#nowhere">x</a></body>'), encoding="utf-8")
    assert chromium.faults(chromium.look_at(page, tmp_path / "dead")) == ["dead link: #nowhere"]


def test_unknown_values_are_dashes_and_the_best_ratio_is_bold(cases):
    case = cases.Case("numbers", "odd", title="Numbers", about="", premeshed="nothing",
                      measured="all")
    nothing = {"gmsh": None}
    case.add("a", "none", "a.msh", {"elements": None, "ratio_max": float("nan")}, seconds=nothing)
    case.add("b", "some", "b.msh", {"elements": 1234567, "ratio_max": 2.126, "ratio_99": 1.5,
                                    "length_median": 0.987, "length_share_good": 0.12345},
             seconds={"gmsh": 123.4, "meshgrow": 0.0012}, facts={"words": "a < b", "nothing": None})
    case.add("c", "more", "c.msh", {"elements": 12, "ratio_max": 1.5, "ratio_99": 1.5},
             seconds={"gmsh": 0, "meshgrow": 1.234},
             facts={"part": 0.0123, "nothing": float("inf")})
    case.save()
    page = page_of(cases)
    rows = table_of(page)
    assert rows["none"] == ["-"] * 9
    assert rows["some"] == ["1,234,567", "2.13", "*1.50*", "0.99", "12.3", "-", "-", "123",
                            "< 0.01"]
    assert rows["more"] == ["12", "*1.50*", "*1.50*", "-", "-", "-", "-", "0", "1.2"]
    facts = [" ".join(row[0].split()) for row in Reader(page).rows if len(row) == 1]
    assert facts == ["words - nothing - part -", "words a < b nothing - part -",
                     "words - nothing - part 0.0123"]


def test_odd_characters_stay_text(cases):
    markup = '<script>alert(1)</script><img src=x onerror=alert(1)>" \' & {% raw %} \ud800'
    case = cases.Case("odd", "q", title=markup, about=markup, premeshed=markup, measured=markup,
                      figures=markup)
    case.record["example"] = "odd name?#%41"
    case.add("a", markup, "a b?#%41.msh", {}, seconds={}, facts={markup: markup})
    case.record["variants"][0]["lines"] = [markup]
    Path(cases.OUT, "a b?#%41.msh").write_text("a mesh")
    Path(cases.OUT, "odd.case.json").write_text(json.dumps(case.record))
    page = page_of(cases)
    text = page.read_text(encoding="utf-8")
    assert "<script" not in text and "onerror" in text
    assert not re.search(r"<img[^>]*src=x", text)
    assert "{% raw %}" in text
    assert links_to_files(page) == ["a b?#%41.msh"]


def test_a_page_without_cases_says_how_to_make_some(cases):
    assert "examples/run.sh" in page_of(cases).read_text(encoding="utf-8")


def test_a_damaged_case_is_named_and_the_page_of_before_stays(cases):
    page = page_of(cases)
    before = page.read_bytes()
    Path(cases.OUT, "broken.case.json").write_text('{"example": "half')
    made = make_page(cases)
    assert made.returncode == 1
    assert "broken.case.json" in made.stderr and "Traceback" not in made.stderr
    assert page.read_bytes() == before
    Path(cases.OUT, "broken.case.json").write_text('{"example": "half"}')
    made = make_page(cases)
    assert made.returncode == 1 and "run the examples again" in made.stderr
    assert sorted(path.name for path in page.parent.iterdir()) == ["broken.case.json", "index.html"]


def test_nothing_is_taken_from_elsewhere(cases):
    text = page_of(cases).read_text(encoding="utf-8")
    assert not re.findall(r"""(?:https?:)?//[\w.]+|@import|url\(""", text)


class Reader(HTMLParser):
    """Collects links and the rows of the tables, with *bold* cells; checks that tags are closed."""

    def __init__(self, page):
        super().__init__()
        self.links, self.rows, self.open = [], [], []
        self.feed(page.read_text(encoding="utf-8"))
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        if tag not in VOID_ELEMENTS:
            self.open.append(tag)
        if tag == "a":
            self.links.append(dict(attributes)["href"])
        if tag == "tr":
            self.rows.append([])
        if tag in ("th", "td"):
            self.rows[-1].append("")
        if tag == "strong":
            self.rows[-1][-1] += "*"

    def handle_endtag(self, tag):
        assert self.open.pop() == tag
        if tag == "strong":
            self.rows[-1][-1] += "*"

    def handle_data(self, data):
        if {"th", "td"} & set(self.open):
            self.rows[-1][-1] += data


def links_to_files(page):
    return sorted({unquote(link) for link in Reader(page).links if not link.startswith("#")})


def table_of(page):
    return {row[0]: row[1:] for row in Reader(page).rows}
