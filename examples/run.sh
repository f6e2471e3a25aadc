#!/usr/bin/env bash
# Sets up a fresh machine, builds meshgrow and runs the examples. Arguments pick some of them, for
# example: examples/run.sh figure8
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/setup.sh

all=(figure8 assembly two_faces volume_in_volume real_parts callbacks plain_gmsh with_pygmsh)
export MESHGROW_EXAMPLES_OUT=${MESHGROW_EXAMPLES_OUT:-$PWD/examples/out}
mkdir -p "$MESHGROW_EXAMPLES_OUT"
for example in "${@:-${all[@]}}"; do
  [ -e "examples/$example.py" ] || fail "there is no example '$example': give one of ${all[*]}."
  say "Running examples/$example.py"
  "$python_newest" "examples/$example.py"
done
say "Done. Look at the pictures in examples/out, or open a mesh: gmsh $(ls -t "$MESHGROW_EXAMPLES_OUT"/*.msh | head -n 1)"
