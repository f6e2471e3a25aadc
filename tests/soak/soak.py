"""Meshes random models: python soak.py COUNT FIRST_SEED RESULTS.jsonl

Seeds that the file has already are left out: run it again to go on. Failures are tried without the
library at the end. summary.py reads the file."""

import json
import os
import sys

import gmsh

import batches
from summary import read


def main():
    count, first, path = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    done = {r["seed"] for r in read(path)} if os.path.exists(path) else set()
    seeds = [s for s in range(first, first + count) if s not in done]
    with open(path, "a") as file:
        def write(result):
            file.write(json.dumps(dict(result, gmsh=gmsh.__version__)) + "\n")
            file.flush()
        for number, result in enumerate(batches.run(seeds), 1):
            write(result)
            if sys.stdout.isatty():
                print("\r%d of %d models" % (number, len(seeds)), end="", flush=True)
        for result in read(path):
            if batches.failed_in_the_library(result) and "plain" not in result:
                write(batches.without_the_library(result))


if __name__ == "__main__":
    main()
