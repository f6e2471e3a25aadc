"""Finds what README.md and docs/*.md tell users to run, open or look at."""

import collections
import pathlib
import re

ROOT = pathlib.Path(__file__).parents[2]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]

# One block of code: where it begins, the language of its fence ("" if indented), and its text.
Block = collections.namedtuple("Block", "document line language text")

FENCE = re.compile(r"^( *)```(\w*)$")
LIST_ITEM = re.compile(r"^ *(?:[-*]|\d+\.) ")


def blocks_of(path):
    """All blocks of a document in their order, fenced and indented."""
    blocks, lines, number = [], path.read_text().splitlines(), 0
    text_before, item = False, 0  # whether a paragraph is going on; indentation of a list's text
    while number < len(lines):
        line, begin = lines[number], number
        indent = len(line) - len(line.lstrip(" "))
        fence = FENCE.match(line)
        if fence:
            number += 1
            while lines[number].strip() != "```":
                number += 1
            kept = [kept[len(fence[1]):] for kept in lines[begin + 1:number]]
            blocks.append(Block(path.name, begin + 1, fence[2], "\n".join(kept) + "\n"))
            text_before = False
        elif line.strip() and not text_before and indent >= item + 4:
            while number + 1 < len(lines) and (lines[number + 1].startswith(" " * indent)
                                               or not lines[number + 1].strip()):
                number += 1
            kept = [kept[indent:] for kept in lines[begin:number + 1]]
            blocks.append(Block(path.name, begin + 1, "", "\n".join(kept).rstrip() + "\n"))
        else:
            text_before = bool(line.strip())
            if LIST_ITEM.match(line):
                item = LIST_ITEM.match(line).end()
            elif line.strip() and indent == 0 and not (number and lines[number - 1].strip()):
                item = 0
        number += 1
    return blocks


def prose_of(path):
    """The document without its fenced blocks."""
    return re.sub(r"(?ms)^ *```.*?^ *```$", "", path.read_text())


def inline_code_of(path):
    """What stands between single backquotes, each once; a line may break within."""
    found = re.findall(r"(?<!`)`([^`]+)`(?!`)", prose_of(path))
    return sorted({re.sub(r"\s+", " ", code) for code in found})


def links_of(path):
    """Targets of links and pictures."""
    return re.findall(r"\]\(([^)\s]+)\)", prose_of(path))


def anchors_of(path):
    """Anchors that its headings make, as GitHub forms them."""
    headings = re.findall(r"(?m)^#+ (.+)$", prose_of(path))
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}
