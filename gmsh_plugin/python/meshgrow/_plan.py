"""The passes of a meshing run."""


class Plan(list):
    """A list of passes, each a dictionary; printed, text for people."""

    def __init__(self, passes, text):
        for number in passes:
            for key in ("entities", "sources"):
                number[key] = [tuple(entity) for entity in number[key]]
        super().__init__(passes)
        self._text = text

    def __str__(self):
        return self._text.rstrip("\n")
