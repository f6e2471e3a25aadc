"""What C programs may pass and must not: null pointers, and reports that are none."""

import ctypes

import meshgrow
import pytest
from meshgrow._library import lib

import models

REPORT = {"elements": 5, "smallest_size": 0.1, "largest_size": 0.2, "ratio_max": 1.5,
          "ratio_99": 1.2, "length_median": None, "length_share_good": None,
          "length_share_over_2": None, "gamma_min": 0.5, "gamma_mean": 0.7, "sicn_min": 0.5,
          "sicn_mean": 0.6}


@pytest.fixture
def field():
    models.square()
    made = meshgrow.SizeField()
    made.add("fixed source Curve{1} attach Surface{1} size 0.1 growth 1.2 limit 1")
    return made


def last_error():
    return lib.meshgrow_last_error().decode()


@pytest.mark.parametrize("name, arguments, what", [
    ("add", [None], "text of a size function"),
    ("rename", [None, b"b"], "name of a size function"),
    ("rename", [b"1", None], "new name of a size function"),
    ("modify", [None, b"fixed"], "name of a size function"),
    ("modify", [b"1", None], "text of a size function"),
    ("remove", [None], "name of a size function"),
    ("save", [None], "path of a size field"),
    ("set_option", [None, 1.0], "name of an option"),
    ("add_mesh", [None, 2, None, 0, 1.2, 1.0, 0], "list of entities"),
    ("create_defaults", [None, 2, 1.2, 1.0, 0.0], "list of entities"),
    ("size", [2, 1, None, 1, None], "array of points"),
    ("exact_size", [2, 1, None, 1, None], "array of points"),
    ("smallest_size", [None, 1, None], "array of points"),
    ("write_view", [None, -1, 0, None], "path of a size field"),
    ("add_view", [b"a", b"cells", -1, 0, None, 0, None], "place for the tag"),
    ("add_view", [None, b"cells", -1, 0, None, 0, ctypes.c_int()], "name of a view"),
    ("add_view", [b"a", None, -1, 0, None, 0, ctypes.c_int()], "kind of a view"),
])
def test_null_pointers_are_named(field, name, arguments, what):
    arguments = [ctypes.byref(a) if isinstance(a, ctypes.c_int) else a for a in arguments]
    assert getattr(lib, "meshgrow_field_" + name)(field._handle, *arguments) != 0
    assert what in last_error() and "null pointer" in last_error()
    assert list(field.functions()) == ["1"]


def test_null_pointers_for_what_is_returned(field):
    assert not lib.meshgrow_field_load(None)
    assert "path of a size field is a null pointer" in last_error()
    assert not lib.meshgrow_field_probe_json(field._handle, 2, 1, None)
    assert "point to probe is a null pointer" in last_error()
    assert not lib.meshgrow_report_table(None)
    assert "report is a null pointer" in last_error()
    assert lib.meshgrow_report_value(None, b"elements", None) != 0
    assert "report is a null pointer" in last_error()
    assert lib.meshgrow_report_value(b"{}", None, None) != 0
    assert "name of a value is a null pointer" in last_error()


def test_null_arrays_without_length_are_no_error(field):
    assert lib.meshgrow_field_size(field._handle, 2, 1, None, 0, None) == 0
    assert lib.meshgrow_field_create_defaults(field._handle, None, 0, 1.2, 1.0, 0.0) == 0


def test_a_null_field_is_told():
    for call in (lambda: lib.meshgrow_field_add(None, b"mesh"),
                 lambda: lib.meshgrow_field_generate(None, 3, 0),
                 lambda: lib.meshgrow_field_save(None, b"a.mgf")):
        assert call() != 0
        assert "no size field" in last_error()
    lib.meshgrow_field_destroy(None)


def sentence_of_table(reports):
    with pytest.raises(meshgrow.Error) as refused:
        meshgrow.report_table(reports)
    sentence = str(refused.value)
    assert sentence.endswith(".") and "json" not in sentence and "exception" not in sentence
    return sentence


def test_reports_that_are_none_are_told_in_our_words():
    assert "a" in meshgrow.report_table({"a": REPORT})
    assert '"a" has no value "elements"' in sentence_of_table({"a": {}})
    assert '"a" has no value "elements"' in sentence_of_table({"a": 7})
    less = {name: value for name, value in REPORT.items() if name != "sicn_mean"}
    assert '"b ß" has no value "sicn_mean"' in sentence_of_table({"a": REPORT, "b ß": less})
    for elements in (-1, "many", None, 1.5):
        assert '"a" has no number of elements' in sentence_of_table(
            {"a": {**REPORT, "elements": elements}})
    for text in (b"", b"{", b"nonsense", b"\xff"):
        assert not lib.meshgrow_report_table(text)
        assert "no JSON" in last_error() and "parse" not in last_error()
    for text in (b"7", b'{"a": 1}', b"[7]", b'[{"name": 3, "report": {}}]', b'[{"name": "a"}]'):
        assert not lib.meshgrow_report_table(text)
        assert "give each report so" in last_error(), text
    value = ctypes.c_double()
    for text in (b"[]", b"7", b"{}"):
        assert lib.meshgrow_report_value(text, b"elements", ctypes.byref(value)) != 0
        assert 'no value "elements"' in last_error()
