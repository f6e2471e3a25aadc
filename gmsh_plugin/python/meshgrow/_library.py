"""The shared library behind the package, and what passes its C border."""

from __future__ import annotations

import ctypes
import operator
import os
from typing import Any, Iterable, List, NoReturn, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt

#: Entities as in gmsh: (dimension 0 to 3, tag) each.
DimTag = Tuple[int, int]
DimTags = Iterable[DimTag]
Doubles = npt.NDArray[np.float64]

_DOUBLE = ctypes.c_double
_SIZE = ctypes.c_size_t
_INT = ctypes.c_int
_INTS = ctypes.POINTER(_INT)
_DOUBLES = ctypes.POINTER(_DOUBLE)
_FIELD = ctypes.c_void_p
_TEXT = ctypes.c_void_p  # a char* that must be freed, so not c_char_p

PROGRESS_LISTENER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_char_p, ctypes.c_void_p)
STOP_REQUEST = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
USER_SIZES = ctypes.CFUNCTYPE(_DOUBLE, _INT, _INT, _DOUBLE, _DOUBLE, _DOUBLE, _DOUBLE,
                              ctypes.c_void_p)

_SIGNATURES = {
    "meshgrow_version": (ctypes.c_char_p, []),
    "meshgrow_last_error": (ctypes.c_char_p, []),
    "meshgrow_free": (None, [_TEXT]),
    "meshgrow_field_create": (_FIELD, []),
    "meshgrow_field_destroy": (None, [_FIELD]),
    "meshgrow_field_add_mesh": (
        _INT, [_FIELD, _INTS, _SIZE, _INTS, _SIZE, _DOUBLE, _DOUBLE, _INT]),
    "meshgrow_field_add_fixed": (
        _INT, [_FIELD, _INTS, _SIZE, _INTS, _SIZE, _DOUBLE, _DOUBLE, _DOUBLE]),
    "meshgrow_field_add_curvature": (
        _INT, [_FIELD, _INTS, _SIZE, _INTS, _SIZE, _DOUBLE, _DOUBLE, _DOUBLE, _DOUBLE]),
    "meshgrow_field_add_proximity": (
        _INT, [_FIELD, _INTS, _SIZE, _INTS, _SIZE, _DOUBLE, _DOUBLE, _DOUBLE, _DOUBLE, _INT]),
    "meshgrow_field_create_defaults": (
        _INT, [_FIELD, _INTS, _SIZE, _DOUBLE, _DOUBLE, _DOUBLE]),
    "meshgrow_field_add": (_INT, [_FIELD, ctypes.c_char_p]),
    "meshgrow_field_function_count": (_SIZE, [_FIELD]),
    "meshgrow_field_function_name": (_TEXT, [_FIELD, _SIZE]),
    "meshgrow_field_function_text": (_TEXT, [_FIELD, _SIZE]),
    "meshgrow_field_rename": (_INT, [_FIELD, ctypes.c_char_p, ctypes.c_char_p]),
    "meshgrow_field_modify": (_INT, [_FIELD, ctypes.c_char_p, ctypes.c_char_p]),
    "meshgrow_field_remove": (_INT, [_FIELD, ctypes.c_char_p]),
    "meshgrow_field_save": (_INT, [_FIELD, ctypes.c_char_p]),
    "meshgrow_field_load": (_FIELD, [ctypes.c_char_p]),
    "meshgrow_field_set_option": (_INT, [_FIELD, ctypes.c_char_p, _DOUBLE]),
    "meshgrow_field_set_progress": (_INT, [_FIELD, PROGRESS_LISTENER, ctypes.c_void_p]),
    "meshgrow_field_set_stop": (_INT, [_FIELD, STOP_REQUEST, ctypes.c_void_p]),
    "meshgrow_field_refresh": (_INT, [_FIELD]),
    "meshgrow_field_register": (_INT, [_FIELD]),
    "meshgrow_field_unregister": (_INT, [_FIELD]),
    "meshgrow_field_generate": (_INT, [_FIELD, _INT, _INT]),
    "meshgrow_field_plan": (_TEXT, [_FIELD, _INT]),
    "meshgrow_field_plan_json": (_TEXT, [_FIELD, _INT]),
    "meshgrow_field_combine": (_INT, [_FIELD, USER_SIZES, ctypes.c_void_p]),
    "meshgrow_field_size": (_INT, [_FIELD, _INT, _INT, _DOUBLES, _SIZE, _DOUBLES]),
    "meshgrow_field_exact_size": (_INT, [_FIELD, _INT, _INT, _DOUBLES, _SIZE, _DOUBLES]),
    "meshgrow_field_smallest_size": (_INT, [_FIELD, _DOUBLES, _SIZE, _DOUBLES]),
    "meshgrow_field_add_view": (
        _INT, [_FIELD, ctypes.c_char_p, ctypes.c_char_p, _INT, _INT, _DOUBLES, _INT, _INTS]),
    "meshgrow_field_write_view": (
        _INT, [_FIELD, ctypes.c_char_p, _INT, _INT, ctypes.POINTER(_SIZE)]),
    "meshgrow_field_probe_json": (_TEXT, [_FIELD, _INT, _INT, _DOUBLES]),
    "meshgrow_field_answer": (
        _DOUBLE, [_FIELD, _INT, _INT, _DOUBLE, _DOUBLE, _DOUBLE, _DOUBLE]),
    "meshgrow_field_callback": (
        _DOUBLE, [_INT, _INT, _DOUBLE, _DOUBLE, _DOUBLE, _DOUBLE, _FIELD]),
    "meshgrow_field_callback_4_8": (_DOUBLE, [_INT, _INT, _DOUBLE, _DOUBLE, _DOUBLE, _FIELD]),
    "meshgrow_field_summary": (_TEXT, [_FIELD]),
    "meshgrow_field_summary_json": (_TEXT, [_FIELD]),
    "meshgrow_report_json": (_TEXT, [_INT, _INTS, _SIZE, _FIELD]),
    "meshgrow_report_value": (_INT, [ctypes.c_char_p, ctypes.c_char_p, _DOUBLES]),
    "meshgrow_report_table": (_TEXT, [ctypes.c_char_p]),
}


class Error(RuntimeError):
    """What meshgrow raises: one sentence that names the entity and the remedy."""


def _find_library() -> str:
    """The library beside the package (installed), in the build tree, or named by MESHGROW_LIB."""
    here = os.path.dirname(os.path.abspath(__file__))
    named = os.environ.get("MESHGROW_LIB")
    candidates = [named] if named else [
        os.path.join(here, "libmeshgrow.so"),
        # Lexically, since the package is a link to the sources in the build tree.
        os.path.normpath(os.path.join(here, "..", "..", "lib", "libmeshgrow.so")),
    ]
    for path in candidates:
        if os.path.exists(path):
            return path
    raise ImportError("libmeshgrow.so was not found (looked at %s): build meshgrow first, or set "
                      "MESHGROW_LIB to its path." % ", ".join(candidates))


def _load() -> ctypes.CDLL:
    library = ctypes.CDLL(_find_library())
    for name, (result, arguments) in _SIGNATURES.items():
        function = getattr(library, name)
        function.restype = result
        function.argtypes = arguments
    return library


lib = _load()


def version() -> str:
    """Version of the library, such as "0.1.0"."""
    return str(lib.meshgrow_version().decode())


def raise_last_error() -> NoReturn:
    """Raises the sentence of the last failure in this thread."""
    raise Error(lib.meshgrow_last_error().decode(errors="replace"))


def check(failed: Union[int, bool]) -> None:
    """Raises the library's last error if a call failed."""
    if failed:
        raise_last_error()


def c_text(text: str) -> bytes:
    """A text for the C border, where NUL would end it."""
    if "\0" in text:
        raise ValueError("a text has a NUL character: %r" % text)
    return text.encode()


def c_path(path: Union[str, os.PathLike[str]]) -> bytes:
    """A path for the C border."""
    encoded = os.fsencode(path)
    if b"\0" in encoded:
        raise ValueError("a path has a NUL character: %r" % (path,))
    return encoded


def take_text(text: Optional[int]) -> str:
    """A returned text as str, its memory freed; raises the last error if there is none."""
    if not text:
        raise_last_error()
    try:
        return ctypes.string_at(text).decode(errors="replace")
    finally:
        lib.meshgrow_free(text)


def dim_tags(entities: DimTags) -> Tuple[Any, int]:
    """A list of (dim, tag) as the C array of ints and its length."""
    flat: List[int] = []
    for dim, tag in entities:
        flat += [operator.index(dim), operator.index(tag)]
    if any(abs(value) > 2**31 - 1 for value in flat):
        raise ValueError("a dimension or tag is beyond the range of Gmsh's integers")
    return (_INT * len(flat))(*flat), len(flat)


def doubles(array: Doubles) -> Any:
    """Pointer to the data of a contiguous float64 array."""
    return array.ctypes.data_as(_DOUBLES)


def points_array(points: npt.ArrayLike) -> Doubles:
    """Points as a contiguous float64 array of shape (n, 3); one that is so already, without a copy."""
    array = np.ascontiguousarray(points, dtype=np.float64)
    if array.ndim == 1:
        array = array.reshape(1, -1)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError("points must have the shape (n, 3), not %s" % (array.shape,))
    return array


def sizes_array(out: Optional[Doubles], count: int) -> Doubles:
    """An array for this many sizes: ``out`` if one is given and fits."""
    if out is None:
        return np.empty(count)
    if not isinstance(out, np.ndarray) or out.dtype != np.float64 or out.shape != (count,):
        raise ValueError("out must be a float64 array of the shape (%d,), one size a point" % count)
    if not (out.flags.c_contiguous and out.flags.writeable):
        raise ValueError("out must be contiguous and writeable")
    return out
