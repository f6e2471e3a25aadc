#!/usr/bin/env bash
# Meshes random models with both generations of Gmsh, checks each, and sums up.
#
#   tests/soak.sh [count] [first seed]    1000 models from seed 1 on
#
# Takes half a second of the processor for most models, and up to a minute for those that fail.
# Results are lines in build/soak; run it again to go on where it was stopped. It fails where the
# library failed, changed what was meshed before, or left a mesh that is not valid.
set -euo pipefail
cd "$(dirname "$0")/.."
count=${1:-1000}
first=${2:-1}
. tests/setup.sh

export MESHGROW_LIB=$build/lib/libmeshgrow.so PYTHONDONTWRITEBYTECODE=1
export PYTHONPATH=$build/python:$root/tests/python
mkdir -p "$build/soak"
debian=$build/soak/debian_${first}_$count.jsonl
newest=$build/soak/newest_${first}_$count.jsonl

say "Meshing $count models from seed $first on"
MESHGROW_GMSH_LIB=$libgmsh_debian "$python_debian" tests/soak/soak.py "$count" "$first" "$debian" &
MESHGROW_GMSH_LIB=$libgmsh_newest "$python_newest" tests/soak/soak.py "$count" "$first" "$newest"
wait $!

status=0
MESHGROW_GMSH_LIB=$libgmsh_newest "$python_newest" tests/soak/summary.py "$debian" "$newest" ||
  status=1

say "Memory that models leave behind"
MESHGROW_GMSH_LIB=$libgmsh_debian "$python_debian" tests/soak/memory.py || status=1
MESHGROW_GMSH_LIB=$libgmsh_newest "$python_newest" tests/soak/memory.py || status=1
exit $status
