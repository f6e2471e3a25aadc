"""Writes what tests/tidy.sh gives to clang-tidy, out of the compile commands of a build folder.

Most of clang-tidy's time goes into the headers of Eigen, of the standard library and of the tests.
Files of the library with the same flags are therefore read together, a few of them as one: a fifth
of the time. Tests have helpers of the same names, and are read one by one.

    tidy_batches.py SOURCE_FOLDER BUILD_FOLDER [FILE ...]

BUILD_FOLDER/batches gets the files to check, and compile_commands.json with their commands and
those of all single files. With FILEs, only these, one by one.
"""

import json
import shlex
import sys
from pathlib import Path

FILES_OF_BATCH = 8


def flags_of(entry):
    """The command without the file that it reads and the one that it writes."""
    words = shlex.split(entry["command"])
    output = words.index("-o")
    return [word for word in words[:output] + words[output + 2:] if word not in ("-c", entry["file"])]


def commands_of_sources(source, build):
    """Of every C++ file under git's eyes, the command of its first target."""
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        file = Path(entry["file"])
        if file.suffix == ".cpp" and build not in file.parents:
            commands.setdefault(file, flags_of(entry))
    # An example of a project of its own: as a program linked to Debian's Gmsh.
    commands[source / "examples/cpp_project/box_in_box.cpp"] = commands[source / "examples/crack.cpp"]
    return commands


def batches_of(source, commands):
    """Lists of files to be read together."""
    together = {}
    alone = []
    for file, flags in sorted(commands.items()):
        if file.relative_to(source).parts[0] in ("src", "gmsh_plugin"):
            together.setdefault(tuple(flags), []).append(file)
        else:
            alone.append([file])
    batches = [files[i:i + FILES_OF_BATCH] for files in together.values()
               for i in range(0, len(files), FILES_OF_BATCH)]
    return sorted(batches, key=len, reverse=True) + alone  # the long ones first


def main():
    source, build = (Path(argument).resolve() for argument in sys.argv[1:3])
    commands = commands_of_sources(source, build)
    wanted = [[Path(argument).resolve()] for argument in sys.argv[3:]]
    for [file] in wanted:
        if file not in commands:
            sys.exit(f"error: {file} is no C++ file of the build.")
    folder = build / "batches"
    folder.mkdir(exist_ok=True)
    for old in folder.iterdir():
        old.unlink()
    database = [{"directory": str(build), "file": str(file), "arguments": [*flags, str(file)]}
                for file, flags in commands.items()]
    for number, files in enumerate(wanted or batches_of(source, commands)):
        if len(files) == 1:
            (folder / f"{number:03}.list").write_text(f"{files[0]}\n")
            continue
        batch = folder / f"{number:03}.cpp"
        batch.write_text("".join(f'#include "{file}"\n' for file in files))
        batch.with_suffix(".list").write_text("".join(f"{file}\n" for file in files))
        database.append({"directory": str(build), "file": str(batch),
                         "arguments": [*commands[files[0]], str(batch)]})
    (folder / "compile_commands.json").write_text(json.dumps(database, indent=1))


main()
