"""Size callbacks of users."""

from __future__ import annotations

import inspect
from typing import Callable

#: (dim, tag, x, y, z, lc) -> size, or without lc as in Gmsh 4.8. Model units.
UserSizes = Callable[..., float]


def takes_size_so_far(sizes: UserSizes) -> bool:
    """Whether a callback takes the sixth argument of Gmsh 4.9 and later, the size so far."""
    if not callable(sizes):
        raise ValueError("give a function (dim, tag, x, y, z, lc) -> size, not %r" % (sizes,))
    try:
        signature = inspect.signature(sizes)
    except (TypeError, ValueError):  # written in C, without a signature
        return True
    try:
        signature.bind(0, 0, 0.0, 0.0, 0.0, 0.0)
        return True
    except TypeError:
        pass
    try:
        signature.bind(0, 0, 0.0, 0.0, 0.0)
        return False
    except TypeError:
        raise ValueError("a size callback takes (dim, tag, x, y, z, lc) or (dim, tag, x, y, z), "
                         "not %s" % signature) from None
