"""Meshes random models: python soak.py COUNT FIRST_SEED RESULTS.jsonl

Seeds that the file has already are left out: run it again to go on. summary.py reads the file."""

import json
import os
import sys

import gmsh

import batches


def finished(path):
    if not os.path.exists(path):
        return set()
    with open(path) as file:
        return {json.loads(line)["seed"] for line in file if line.endswith("\n")}


def main():
    count, first, path = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    done = finished(path)
    seeds = [s for s in range(first, first + count) if s not in done]
    with open(path, "a") as file:
        for number, result in enumerate(batches.run(seeds), 1):
            file.write(json.dumps(dict(result, gmsh=gmsh.__version__)) + "\n")
            file.flush()
            if sys.stdout.isatty():
                print("\r%d of %d models" % (number, len(seeds)), end="", flush=True)


if __name__ == "__main__":
    main()
