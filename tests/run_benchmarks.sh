#!/usr/bin/env bash
# Sets up a machine, peers included, and measures meshgrow beside CGAL, Embree and Gmsh itself. All
# numbers are ratios of times taken side by side; they go to the terminal and to
# build/benchmarks.json.
#
#   tests/run_benchmarks.sh            everything: about an hour and a half
#   tests/run_benchmarks.sh --quick    small inputs: about two minutes, for CI
#   tests/run_benchmarks.sh --only grid.build    numbers whose names begin so
#
# It fails where a result is wrong (a size against brute force or above the tolerance, a run that is
# not the recorded one), never because of a time.
set -euo pipefail
cd "$(dirname "$0")/.."
with_benchmarks=1
. tests/setup.sh

quick=()
only=()
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=(--quick) ;;
    --only)
      [ $# -ge 2 ] || fail "give the beginning of a name after --only, for example grid.build."
      only=(--only "$2")
      shift
      ;;
    *) fail "there is no option $1: give --quick or --only NAME." ;;
  esac
  shift
done

json=$build/benchmarks${quick:+_quick}.json
rm -f "$json"
status=0
case ${only[1]:-} in
  mesh* | auto*) ;;
  *)
    say "Kernels beside CGAL and Embree"
    "$build/bin/kernel_benchmarks" "${quick[@]}" "${only[@]}" --json "$json" || status=1
    ;;
esac
case ${only[1]:-} in
  "" | mesh* | auto*)
    gmsh=(--gmsh newest)
    [ ${#quick[@]} -gt 0 ] || gmsh=(--gmsh both)
    say "Whole runs of Gmsh"
    "$python_debian" tests/benchmarks/mesh_runs/mesh_runs.py "${quick[@]}" "${only[@]}" \
      "${gmsh[@]}" --json "$json" || status=1
    ;;
esac
say "Numbers in $json"
exit $status
