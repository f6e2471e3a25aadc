"""Exceptions on their way through the library."""

from ._user_sizes import takes_size_so_far


class Raised:
    """Keeps what Python code raises while the library calls it, to raise it afterwards.

    An object apart from the field, so that the callbacks make no cycle with it: a field must go when
    its last name goes, since that removes it from Gmsh.
    """

    def __init__(self):
        self.exception = None
        self.stops = False

    def keep(self, exception):
        """The first one counts; the next line of progress stops the work."""
        self.exception = self.exception or exception
        self.stops = True

    def forget(self):
        self.exception, self.stops = None, False

    def raise_again(self):
        exception, self.exception, self.stops = self.exception, None, False
        if exception is not None:
            raise exception

    def listener(self, progress):
        """A listener of progress for the library."""
        def listen(line, _):
            if not self.stops:
                try:
                    progress(line.decode())
                except BaseException as raised:  # KeyboardInterrupt as well
                    self.keep(raised)
            return int(self.stops)
        return listen

    def sizes(self, sizes):
        """A size callback for the library; where it raises there is no size."""
        call = sizes if takes_size_so_far(sizes) else (
            lambda dim, tag, x, y, z, lc: sizes(dim, tag, x, y, z))

        def guarded(dim, tag, x, y, z, lc, _):
            if self.exception is not None:
                return -1.0
            try:
                return float(call(dim, tag, x, y, z, lc))
            except BaseException as raised:  # KeyboardInterrupt as well
                self.keep(raised)
                return -1.0
        return guarded
