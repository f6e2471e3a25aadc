#!/usr/bin/env bash
# Sets up a fresh machine and runs all tests, against Debian's Gmsh 4.8.4 and the newest from PyPI,
# then the benchmarks on small inputs: they check results as well. Arguments go to ctest, for
# example: tests/run.sh -R grid; then the benchmarks are left out.
set -euo pipefail
cd "$(dirname "$0")/.."
with_benchmarks=1
. tests/setup.sh

if command -v clang-format >/dev/null; then
  say "Checking the format"
  git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
fi

say "Checking the types of the Python package"
"$build/venv/bin/mypy" --strict --cache-dir "$build/mypy" gmsh_plugin/python/meshgrow

say "Testing"
results=$build/test-results.txt
status=0
ctest --test-dir "$build" --output-on-failure -j2 "$@" | tee "$results" || status=$?
passed=$(grep -c ' Passed ' "$results" || true)
failed=$(grep -cE '\*\*\*(Failed|Timeout|Exception|Not Run)' "$results" || true)
skipped=$(grep -c '\*\*\*Skipped' "$results" || true)
benchmarks=0
if [ $# = 0 ]; then
  tests/run_benchmarks.sh --quick || benchmarks=$?
  [ "$benchmarks" = 0 ] || printf '\nThe benchmarks met wrong results: see above.\n'
fi
printf '\n%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
[ "$status" = 0 ] && [ "$passed" -gt 0 ] && [ "$failed" = 0 ] && [ "$benchmarks" = 0 ]
