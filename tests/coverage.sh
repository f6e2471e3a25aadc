#!/usr/bin/env bash
# Line coverage: builds with clang's counters in build/coverage, runs the tests of core and plugin,
# the C++ programs and the Python tests against both generations of Gmsh, and prints how many lines
# of src/, of gmsh_plugin/ and of the Python package they ran, and those that they did not in the
# files with most of them. Fails below 95 % of src/, below 85 % of gmsh_plugin/ and after a failed
# test. Left out are the tests that take long and run what others run as well: the examples, the
# page, the soak. Arguments go to ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
with_checks=1
without_build=1
. tests/setup.sh

coverage=$build/coverage
mkdir -p "$coverage/python"
ln -sfn "$build/venv" "$coverage/venv"

say "Building with counters in $coverage"
# The counters live in a mapped file: what a process has run is kept even if it is killed.
counters="-fprofile-instr-generate -fcoverage-mapping -mllvm -runtime-counter-relocation"
cmake -S . -B "$coverage" -G Ninja -DCMAKE_BUILD_TYPE=Coverage -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_CXX_FLAGS="-O1 -DNDEBUG $counters" >"$coverage/configure.log" ||
  fail "cmake failed: see $coverage/configure.log"
programs=(core_tests plugin_tests linked_program cpp_program_debian cpp_program_newest)
cmake --build "$coverage" -j2 --target meshgrow meshgrow_program "${programs[@]}" ||
  fail "the build failed."

# Python counts with Debian's coverage, in every process: the tests have this folder in PYTHONPATH.
ln -sfn /usr/lib/python3/dist-packages/coverage "$coverage/python/coverage"
cp tests/coverage_start.py "$coverage/python/sitecustomize.py"
export COVERAGE_PROCESS_START=$coverage/python.ini
cat >"$COVERAGE_PROCESS_START" <<END
[run]
source = $root/gmsh_plugin/python
data_file = $coverage/counts/python
parallel = true
END
export LLVM_PROFILE_FILE=$coverage/counts/%m%c.profraw

say "Testing"
rm -rf "$coverage/counts"
mkdir "$coverage/counts"
status=0
results=$coverage/results.txt
# All tests of the core in two processes, not in one each.
shards=()
for shard in 0 1; do
  GTEST_TOTAL_SHARDS=2 GTEST_SHARD_INDEX=$shard "$coverage/bin/core_tests" --gtest_brief=1 &
  shards+=($!)
done
for shard in "${shards[@]}"; do
  wait "$shard" || status=1
done
ctest --test-dir "$coverage" -j2 --output-on-failure -R '^(plugin|python|linked_program|cpp_program)' \
  -E 'test_(examples|.*_example|page|soak)$' "$@" | tee "$results" || status=1

say "Counting"
objects=("$coverage/lib/libmeshgrow.so" -object "$coverage/bin/meshgrow")
for program in core_tests plugin_tests; do
  objects+=(-object "$coverage/bin/$program")
done
llvm-profdata merge "$coverage"/counts/*.profraw -o "$coverage/counts.profdata"
llvm-cov export -format=lcov -instr-profile="$coverage/counts.profdata" "${objects[@]}" \
  >"$coverage/lines.lcov"
(
  unset COVERAGE_PROCESS_START
  export PYTHONPATH=$coverage/python
  cd "$coverage"
  "$python_debian" -m coverage combine -q --rcfile=python.ini
  "$python_debian" -m coverage json -q --rcfile=python.ini -o python.json
)
"$python_debian" tests/coverage_report.py . "$coverage" src=95 gmsh_plugin=85 || status=1
[ "$status" = 0 ] || printf 'Failed: too little is covered, or tests failed (%s).\n' "$results"
exit $status
