"""The passes of a meshing run."""

from __future__ import annotations

from typing import Any, Dict, List


class Plan(List[Dict[str, Any]]):
    """A list of passes, each a dictionary; printed, text for people."""

    def __init__(self, passes: List[Dict[str, Any]], text: str) -> None:
        for number in passes:
            for key in ("entities", "sources"):
                number[key] = [tuple(entity) for entity in number[key]]
        super().__init__(passes)
        self._text = text

    def __str__(self) -> str:
        return self._text.rstrip("\n")
