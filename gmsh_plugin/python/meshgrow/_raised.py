"""Exceptions on their way through the library."""

from __future__ import annotations

from typing import Any, Callable, Optional

from ._user_sizes import UserSizes, takes_size_so_far


class Raised:
    """Keeps what Python code raises while the library calls it, to raise it afterwards.

    An object apart from the field, so that the callbacks make no cycle with it: a field must go when
    its last name goes, since that removes it from Gmsh.
    """

    def __init__(self) -> None:
        self.exception: Optional[BaseException] = None
        self.stops = False

    def keep(self, exception: BaseException) -> None:
        """The first one counts; the work stops when the library next asks."""
        self.exception = self.exception or exception
        self.stops = True

    def forget(self) -> None:
        self.exception, self.stops = None, False

    def raise_again(self) -> None:
        exception, self.exception, self.stops = self.exception, None, False
        if exception is not None:
            raise exception

    def listener(self, progress: Callable[[str], Any]) -> Callable[[bytes, Any], int]:
        """A listener of progress for the library."""
        def listen(line: bytes, _: Any) -> int:
            if not self.stops:
                try:
                    progress(line.decode(errors="replace"))
                except BaseException as raised:  # KeyboardInterrupt as well
                    self.keep(raised)
            return int(self.stops)
        return listen

    def stop_request(self) -> Callable[[Any], int]:
        """Tells the library to stop. A pending Ctrl-C is kept before it answers."""
        return lambda _: int(self.stops)

    def sizes(self, sizes: UserSizes) -> Callable[..., float]:
        """A size callback for the library; where it raises there is no size."""
        call: UserSizes = sizes if takes_size_so_far(sizes) else (
            lambda dim, tag, x, y, z, lc: sizes(dim, tag, x, y, z))

        def guarded(dim: int, tag: int, x: float, y: float, z: float, lc: float,
                    _: Any) -> float:
            if self.exception is not None:
                return -1.0
            try:
                return float(call(dim, tag, x, y, z, lc))
            except BaseException as raised:  # KeyboardInterrupt as well
                self.keep(raised)
                return -1.0
        return guarded
