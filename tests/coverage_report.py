"""Prints line coverage out of what tests/coverage.sh has counted.

    coverage_report.py SOURCE_FOLDER COVERAGE_FOLDER [ROOM=PERCENT ...]

Reads lines.lcov and python.json of COVERAGE_FOLDER. Counted are lines with code: no comments, no
lone braces. Ends with 1 if a room has fewer PERCENT of its lines covered.
"""

import json
import re
import sys
from pathlib import Path

SHOWN_FILES = 25
SHOWN_RANGES = 40
NO_CODE = re.compile(r"\s*(//.*|[\s{}();,]*|namespace.*|(public|private):|#.*|(\} )?else \{)$")


def lines_of_lcov(path):
    """{file: {line: times}}; the same line of several programs counts together."""
    files = {}
    for record in path.read_text().splitlines():
        name, _, value = record.partition(":")
        if name == "SF":
            lines = files.setdefault(Path(value).resolve(), {})
        elif name == "DA":
            line, times = map(int, value.split(",")[:2])
            lines[line] = lines.get(line, 0) + times
    return files


def lines_of_python(path):
    files = {}
    for name, counted in json.loads(path.read_text())["files"].items():
        lines = dict.fromkeys(counted["executed_lines"], 1)
        lines.update(dict.fromkeys(counted["missing_lines"], 0))
        files[Path(name).resolve()] = lines
    return files


def with_code(file, lines):
    """Of the lines, those that hold code."""
    text = file.read_text().splitlines()
    return {line: times for line, times in lines.items() if not NO_CODE.match(text[line - 1])}


def ranges(numbers):
    """3, 4, 5, 9 as 3-5, 9."""
    parts = []
    for number in numbers:
        if parts and parts[-1][1] == number - 1:
            parts[-1][1] = number
        else:
            parts.append([number, number])
    shown = [str(first) if first == last else f"{first}-{last}" for first, last in parts]
    return ", ".join(shown[:SHOWN_RANGES] + ["..."] * (len(shown) > SHOWN_RANGES))


def percent(lines):
    return 100 * sum(times > 0 for times in lines) / len(lines) if lines else 100


def main():
    source, folder = (Path(argument).resolve() for argument in sys.argv[1:3])
    wanted = dict(argument.split("=") for argument in sys.argv[3:])
    rooms = {"src": {}, "gmsh_plugin": {}, "gmsh_plugin/python": {}}
    counted = {**lines_of_lcov(folder / "lines.lcov"), **lines_of_python(folder / "python.json")}
    for file, lines in counted.items():
        if source not in file.parents:
            continue
        name = file.relative_to(source).as_posix()
        room = max((room for room in rooms if name.startswith(room + "/")), key=len, default=None)
        if room:
            rooms[room][name] = with_code(file, lines)

    files = {name: lines for room in rooms.values() for name, lines in room.items()}
    missing = {name: sorted(line for line, times in lines.items() if times == 0)
               for name, lines in files.items()}
    print("Lines that no test ran, most of them first:")
    for name in sorted(missing, key=lambda name: -len(missing[name]))[:SHOWN_FILES]:
        if missing[name]:
            print(f"{len(missing[name]):4}  {percent(files[name].values()):5.1f} %  {name}: "
                  f"{ranges(missing[name])}")
    print()
    enough = True
    for room, of_room in rooms.items():
        lines = [times for lines in of_room.values() for times in lines.values()]
        least = float(wanted.get(room, 0))
        enough = enough and percent(lines) >= least and bool(lines)
        print(f"{room}: {percent(lines):.1f} % of {len(lines)} lines"
              + (f", at least {least:g} % wanted" if least else ""))
    sys.exit(not enough)


main()
