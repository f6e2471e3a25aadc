"""The size field of a Gmsh model."""

from __future__ import annotations

import json
import operator
import os
from typing import Any, Callable, Dict, Optional, Union

import numpy.typing as npt

from ._library import (PROGRESS_LISTENER, STOP_REQUEST, USER_SIZES, DimTag, DimTags, Doubles, c_path,
                       c_text, check, dim_tags, doubles, lib, points_array, sizes_array, take_text)
from ._interrupts import interrupts_kept
from ._plan import Plan
from ._probe import probe
from ._raised import Raised
from ._user_sizes import UserSizes
from ._view import add_view, write_view

_callback = lib.meshgrow_field_callback
_NO_SIZE = 1e22  # what Gmsh takes for none


class SizeField:
    """Mesh sizes of Gmsh's current model, from its size functions.

    Entities are lists of ``(dim, tag)`` as in gmsh. Lengths are in model units. Raises
    :class:`meshgrow.Error` with one sentence when something is wrong; what raises changes nothing,
    but for :meth:`generate`, which keeps what was meshed before. One thread at a time, as Gmsh, but
    for :meth:`size`, :meth:`exact_size`, :meth:`smallest_size` and the field as a size callback.

    tolerance
        relative tolerance of the background grids: a size is at most ``1 + tolerance`` times exact.
    evaluator
        ``"exact"`` asks the tree of facets each time, ``"grid"`` interpolates in background grids;
        ``"auto"`` builds a grid before a volume is meshed that will ask for so many sizes that it
        pays.
    strict
        a mesh size function whose source has no mesh is an error instead of a warning.
    threads
        that build grids; 0 takes all.
    max_cells
        of each background grid, 40 bytes a cell; 0: as many as half of the available memory holds
        while they are built. A grid that needs more is coarser, with a warning in Gmsh's log: sizes
        keep the tolerance, but more of them are searched for in the facets.
    calibrate
        corrects what Gmsh is told by measured factors, so that its edges get the length asked for:
        without, they are 1.3 times as long in volumes.
    progress
        called with each line of progress (a str), for example ``print``; None: Gmsh's log. An
        exception from it stops the work; what was meshed is kept.
    """

    _file: Optional[Union[str, bytes]] = None  # that it was loaded from

    def __init__(self, tolerance: float = 0.05, evaluator: str = "auto", strict: bool = False,
                 threads: int = 0, progress: Optional[Callable[[str], Any]] = None,
                 calibrate: bool = False, max_cells: int = 0) -> None:
        self._raised = Raised()
        self._handle = lib.meshgrow_field_create()
        check(not self._handle)
        evaluators = ("auto", "grid", "exact")
        if evaluator not in evaluators:
            raise ValueError('evaluator must be "auto", "grid" or "exact", not %r' % (evaluator,))
        self._set("tolerance", tolerance)
        self._set("evaluator", evaluators.index(evaluator))
        self._set("strict", strict)
        self._set("threads", threads)
        self._set("max_cells", max_cells)
        self._set("calibrate", calibrate)
        # Both callbacks are kept as long as the field, which calls them.
        self._stop_request = STOP_REQUEST(self._raised.stop_request())
        check(lib.meshgrow_field_set_stop(self._handle, self._stop_request, None))
        if progress is not None:
            self._listener = PROGRESS_LISTENER(self._raised.listener(progress))
            check(lib.meshgrow_field_set_progress(self._handle, self._listener, None))

    def __del__(self) -> None:
        handle, self._handle = getattr(self, "_handle", None), None
        if handle:
            lib.meshgrow_field_destroy(handle)

    def _call(self, function: Callable[..., int], *arguments: Any) -> None:
        """A call that may take long: raises what Python code raised within it, Ctrl-C included."""
        with interrupts_kept(self._raised.keep):
            failed = function(self._handle, *arguments)
        self._raised.raise_again()
        check(failed)

    def _text(self, function: Callable[..., Optional[int]], *arguments: Any) -> str:
        """The same for a call that returns a text."""
        with interrupts_kept(self._raised.keep):
            text = function(self._handle, *arguments)
        try:
            self._raised.raise_again()
        except BaseException:
            lib.meshgrow_free(text)
            raise
        return take_text(text)

    def _set(self, name: str, value: float) -> None:
        check(lib.meshgrow_field_set_option(self._handle, c_text(name), float(value)))

    def add_mesh(self, sources: DimTags, attach: DimTags, growth_rate: float = 1.2,
                 size_limit: Optional[float] = None, quad_size: str = "triangles",
                 name: Optional[str] = None) -> str:
        """The mesh on the sources (curves, surfaces) grows into the attachments.

        Each layer of elements is ``growth_rate`` (>= 1) times the one before, up to ``size_limit``
        (> 0). Acts on all that bounds or is embedded in the attachments as well. ``quad_size`` is
        ``"triangles"`` (a quadrilateral by its two triangles, diagonal included) or ``"sides"``.
        Returns the name: ``name``, or a number in the order of adding.
        """
        if quad_size not in ("triangles", "sides"):
            raise ValueError('quad_size must be "triangles" or "sides", not %r' % (quad_size,))
        self._call(
            lib.meshgrow_field_add_mesh, *dim_tags(sources), *dim_tags(attach), growth_rate,
            _limit(size_limit), int(quad_size == "sides"))
        return self._named(name)

    def add_fixed(self, sources: DimTags, attach: DimTags, size: float, growth_rate: float = 1.2,
                  size_limit: Optional[float] = None, name: Optional[str] = None) -> str:
        """The size ``size`` (> 0) on the sources (points to volumes) grows into the attachments.
        Returns the name."""
        self._call(
            lib.meshgrow_field_add_fixed, *dim_tags(sources), *dim_tags(attach), size, growth_rate,
            _limit(size_limit))
        return self._named(name)

    def add_curvature(self, sources: DimTags, attach: DimTags, angle: float = 18,
                      growth_rate: float = 1.2, size_limit: Optional[float] = None,
                      min_size: float = 0.0, name: Optional[str] = None) -> str:
        """The curvature of the sources (curves, surfaces) grows into the attachments.

        An edge of an element may turn by ``angle`` degrees: the size is 2 sin(angle / 2) over the
        largest curvature, but not below ``min_size``. A volume stands for its faces, a surface in a
        model without volumes for its curves as well. Unmeshed sources are sampled, read only.
        Returns the name.
        """
        self._call(
            lib.meshgrow_field_add_curvature, *dim_tags(sources), *dim_tags(attach), angle,
            growth_rate, _limit(size_limit), min_size)
        return self._named(name)

    def add_proximity(self, sources: DimTags, attach: DimTags, cells_per_gap: float = 3,
                      growth_rate: float = 1.2, size_limit: Optional[float] = None,
                      min_size: float = 0.0, between: Optional[str] = None,
                      name: Optional[str] = None) -> str:
        """The gaps between the sources and what is opposite grow into the attachments.

        ``cells_per_gap`` (> 0, need not be whole) elements fit into each gap, measured through the
        attachments: ``between`` ``"faces"`` of attached volumes, ``"edges"`` of surfaces (attached,
        or bounding an attached volume) or ``"both"``. None takes faces if a volume is attached and
        not all sources are curves, else edges. A volume stands for its faces. Gaps that ask for
        less than ``min_size`` are ignored. Returns the name.
        """
        names = (None, "faces", "edges", "both")
        if between not in names:
            raise ValueError('between must be "faces", "edges", "both" or None, not %r'
                             % (between,))
        self._call(
            lib.meshgrow_field_add_proximity, *dim_tags(sources), *dim_tags(attach), cells_per_gap,
            growth_rate, _limit(size_limit), min_size, names.index(between))
        return self._named(name)

    def create_defaults(self, attach: Optional[DimTags] = None, growth_rate: float = 1.2,
                        size_limit: Optional[float] = None, min_size: float = 0.0) -> None:
        """Adds what suits most models: curvature (18 degrees) and proximity (3 cells per gap,
        between faces and edges) of the attachments themselves.

        Without ``attach``, of all entities of the model's highest dimension.
        """
        self._call(
            lib.meshgrow_field_create_defaults, *dim_tags(attach or ()), growth_rate,
            _limit(size_limit), min_size)

    def add(self, text: str) -> str:
        """A size function by its line of text, the same as on the command line:
        ``"mesh source Surface{7} attach Volume{2} growth 1.2 limit 2"``. It may hold ``name inner``
        or ``name "inner wall"``. Returns the name."""
        self._call(lib.meshgrow_field_add, c_text(text))
        return self._name(lib.meshgrow_field_function_count(self._handle) - 1)

    def _name(self, index: int) -> str:
        return take_text(lib.meshgrow_field_function_name(self._handle, index))

    def _named(self, name: Optional[str]) -> str:
        """Names the function that was added last; if it cannot have this name, there is none."""
        number = self._name(lib.meshgrow_field_function_count(self._handle) - 1)
        if name is None:
            return number
        try:
            self.rename(number, name)
        except BaseException:
            self.remove(number)
            raise
        return name

    def functions(self) -> Dict[str, str]:
        """The size functions in the order of adding: name -> line of text."""
        return {self._name(i): take_text(lib.meshgrow_field_function_text(self._handle, i))
                for i in range(lib.meshgrow_field_function_count(self._handle))}

    def modify(self, name: str, text: str) -> None:
        """Puts another definition, a line of text, in the place of a function. Only what it acts on
        is built anew; a registered field acts as changed at once."""
        self._call(lib.meshgrow_field_modify, c_text(name), c_text(text))

    def remove(self, name: str) -> None:
        """Takes a function away."""
        self._call(lib.meshgrow_field_remove, c_text(name))

    def rename(self, name: str, new_name: str) -> None:
        """Gives a function another name."""
        check(lib.meshgrow_field_rename(self._handle, c_text(name), c_text(new_name)))

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Saves the field, with grids unless the evaluator is exact, to a file (.mgf) that is
        complete or not there."""
        self._call(lib.meshgrow_field_save, c_path(path))

    @classmethod
    def load(cls, path: Union[str, os.PathLike[str]]) -> SizeField:
        """A saved field, mapped into memory. It answers as the saved one did, to the bit, and can be
        asked, shown and registered (with a model that has the entities it acts on), but not changed.
        Needs no gmsh unless registered."""
        field = cls.__new__(cls)
        field._raised = Raised()
        field._handle = lib.meshgrow_field_load(c_path(path))
        check(not field._handle)
        field._file = os.path.abspath(path)
        return field

    def __reduce__(self) -> Any:
        """A loaded field travels as the path of its file, so that workers map it by themselves."""
        if self._file is None:
            raise TypeError("a size field of a model cannot be copied or sent to another process: "
                            "save it, and load the file there")
        return type(self).load, (self._file,)

    def generate(self, dim: int = 3, remesh: bool = False) -> None:
        """Meshes up to dimension ``dim`` with Gmsh's own algorithms, sources first.

        What had a mesh before keeps it: node tags, coordinates to the bit, connectivity. Only where
        Mesh.ElementOrder is 2 or more, elements of first order get mid nodes beside their own. With
        ``remesh``, all that is no source of a mesh size function loses its mesh first; discrete
        entities keep theirs.

        After an error or Ctrl-C, what was meshed before is kept, but for curves of mapped surfaces
        that were not adjusted to each other yet; options, visibility and premeshed entities are as
        before, and the next call goes on.
        """
        dim = operator.index(dim)
        self._raised.raise_again()  # of a callback in Gmsh's own generate()
        self._call(lib.meshgrow_field_generate, dim, bool(remesh))

    def plan(self, dim: int = 3) -> Plan:
        """The passes of ``generate(dim)``, without meshing: a list of dictionaries with ``dim``,
        ``attached``, ``entities``, ``functions`` (indices) and ``sources`` (read before the pass).
        Printed, it reads as text."""
        dim = operator.index(dim)
        return Plan(json.loads(self._text(lib.meshgrow_field_plan_json, dim)),
                    self._text(lib.meshgrow_field_plan, dim))

    def combine(self, sizes: Optional[UserSizes]) -> None:
        """Sizes of your own beside the field: Gmsh is told the smaller one, in the whole model.

        ``sizes`` is a size callback as Gmsh takes it, ``(dim, tag, x, y, z, lc)`` or, as in Gmsh
        4.8, ``(dim, tag, x, y, z)``; None ends that. Gmsh keeps one callback only and does not tell
        it: give the one of your ``setSizeCallback`` here. What it raises is raised by ``generate``.
        """
        self._raised.forget()  # what the callback before raised
        if sizes is None:
            check(lib.meshgrow_field_combine(self._handle, USER_SIZES(), None))
            self._user_sizes = None
            return
        user_sizes = USER_SIZES(self._raised.sizes(sizes))
        check(lib.meshgrow_field_combine(self._handle, user_sizes, None))
        self._user_sizes = user_sizes  # Kept as long as the field, which calls it.

    def register(self) -> None:
        """Reads the sources as they are meshed now and becomes Gmsh's size callback.

        Only the callback: you mesh, with ``gmsh.model.mesh.generate``. A source that gets its mesh
        in a lower dimension of the same call is read then, and sizes are exact ones (slower than
        from grids) until ``refresh`` between two calls builds grids.
        """
        self._call(lib.meshgrow_field_register)

    def unregister(self) -> None:
        """Takes the size callback away again."""
        check(lib.meshgrow_field_unregister(self._handle))

    def refresh(self) -> None:
        """Reads the sources as they are meshed now and builds trees, and grids where they pay. If
        it raises, the field answers as before."""
        self._call(lib.meshgrow_field_refresh)

    def __call__(self, dim: int, tag: int, x: float, y: float, z: float,
                 lc: float = _NO_SIZE) -> float:
        """The field as a size callback of Gmsh: the smaller one of ``lc`` and the size asked for on
        the entity at the point. With Gmsh 4.8, which passes no ``lc``, 1e22 where no function acts.

            gmsh.model.mesh.setSizeCallback(field)

        or within a callback of your own. The first call reads the sources, as ``register`` does; a
        mesh that Gmsh throws away as it begins is taken as it was when the function was added.
        Raises nothing: where the field cannot answer, a warning in Gmsh's log says why, and ``lc``
        is the answer. May be called from several threads. Gmsh runs Python code for each size;
        ``register`` does without.
        """
        return _callback(dim, tag, x, y, z, lc, self._handle)  # type: ignore[no-any-return]

    def size(self, dim: int, tag: int, points: npt.ArrayLike,
             out: Optional[Doubles] = None) -> Doubles:
        """Sizes asked for on an entity at points (n, 3) -> (n,) float64; inf where none acts.

        Before Gmsh applies Mesh.MeshSizeMin, Max and Factor to them. Points that are a contiguous
        float64 array are not copied; ``out``, a contiguous float64 array of the shape (n,), takes
        the result and is returned. Raises Error if the entity is not in the model.
        """
        return self._sizes(lib.meshgrow_field_size, dim, tag, points, out)

    def exact_size(self, dim: int, tag: int, points: npt.ArrayLike,
                   out: Optional[Doubles] = None) -> Doubles:
        """The same without the grid: the minimum over all facets of the sources."""
        return self._sizes(lib.meshgrow_field_exact_size, dim, tag, points, out)

    def probe(self, dim: int, tag: int, point: npt.ArrayLike) -> Dict[str, Any]:
        """What decides the size on an entity at a point, as a dictionary.

        ``size`` is what is answered, ``exact_size`` without and ``interpolated_size`` with a grid
        (None if there is none), ``rule`` is ``"facet"``, ``"limit"``, ``"inside source"`` or
        ``"nothing"``, ``function`` has ``index``, ``name``, ``kind`` and ``text``, and ``facet``
        (None for other rules) its ``entity``, ``element`` (tag, or None), ``corners``,
        ``start_size``, ``growth_rate``, ``slope`` and ``distance`` from the point.
        """
        return probe(self._text, operator.index(dim), operator.index(tag), point)

    def smallest_size(self, points: npt.ArrayLike, out: Optional[Doubles] = None) -> Doubles:
        """The same for who knows no entity: the smallest size that any function asks for."""
        array = points_array(points)
        result = sizes_array(out, len(array))
        self._call(lib.meshgrow_field_smallest_size, doubles(array), len(array), doubles(result))
        return result

    def add_view(self, name: str = "sizes", kind: str = "cells", entity: Optional[DimTag] = None,
                 plane: Any = None, resolution: Optional[int] = None) -> int:
        """Puts the field into Gmsh as a post-processing view; returns the view's tag.

        ``kind`` is ``"cells"`` (of the background grid), ``"plane"`` (a cut) or ``"mesh"`` (at the
        nodes of the mesh that the model has). Shows the field of ``entity``, a ``(dim, tag)``, or
        the smallest size that any function asks for. ``plane`` is ``"x=0.5"`` or a point and a
        normal; None cuts through the middle, square to the shortest side of the box (to z where
        sides are equal). ``resolution`` squares along the longer side of the cut (32) are divided
        further where sizes bend.
        """
        return add_view(self._call, name, kind, entity, plane, resolution)

    def write_view(self, path: Union[str, os.PathLike[str]],
                   entity: Optional[DimTag] = None) -> int:
        """Writes the field into a file that other programs read; returns how many cells it has.

        By the ending of ``path``: ``.vtu`` (ParaView: the cells of the background grid), ``.pos``
        (a view that any Gmsh can take for a background field, within the tolerance) or ``.msh``
        (the same cells as a mesh). Of the field of ``entity``, a ``(dim, tag)``, or of the smallest
        size that any function asks for. The file is there completely, or as before.
        """
        return write_view(self._call, path, entity)

    def _sizes(self, function: Callable[..., int], dim: int, tag: int, points: npt.ArrayLike,
               out: Optional[Doubles]) -> Doubles:
        array = points_array(points)
        result = sizes_array(out, len(array))
        self._call(function, dim, tag, doubles(array), len(array), doubles(result))
        return result

    def summary(self) -> str:
        """Functions, groups and grids as text for people."""
        return self._text(lib.meshgrow_field_summary)

    def statistics(self) -> Dict[str, Any]:
        """The same as a dictionary: ``functions`` and ``groups``, each a list, and ``seconds``.

        The last is the wall time of the last ``generate``: ``gmsh``, in Gmsh's meshers, the sizes
        that they ask for included, and ``meshgrow``, the rest.
        """
        result: Dict[str, Any] = json.loads(
            self._text(lib.meshgrow_field_summary_json))
        return result


def _limit(size_limit: Optional[float]) -> float:
    if size_limit is None:
        raise ValueError("give size_limit, the largest size that the function asks for")
    return size_limit
