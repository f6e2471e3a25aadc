"""Ctrl-C while the library works."""

from __future__ import annotations

import contextlib
import signal
import threading
from typing import Callable, Iterator


@contextlib.contextmanager
def interrupts_kept(keep: Callable[[BaseException], None]) -> Iterator[None]:
    """Hands a KeyboardInterrupt to ``keep`` instead of raising it, where Python would raise it.

    Python raises it between two of its own instructions; within the library these are in callbacks,
    out of which nothing can be raised. (Gmsh's Python module makes Ctrl-C end the process at once;
    then this does nothing.)
    """
    in_main_thread = threading.current_thread() is threading.main_thread()
    if not in_main_thread or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, lambda *_: keep(KeyboardInterrupt()))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
