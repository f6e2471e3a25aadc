#!/usr/bin/env bash
# Fuzzes what reads from outside, with libFuzzer, AddressSanitizer and UndefinedBehaviorSanitizer:
#
#   tests/fuzz.sh [SECONDS [TARGET]…]     each target so long (30); all of tests/fuzz, or those named
#
# Inputs that reach something new are kept in build/fuzz/corpus, where the next run begins. What is
# found is written to build/fuzz/found, and the exit status is 1. Once mended, such a file goes to
# tests/fuzz/found/TARGET: the tests (ctest -R fuzz) run it from then on.
set -euo pipefail
cd "$(dirname "$0")/.."
without_build=1
with_checks=1
. tests/setup.sh

seconds=${1:-30}
[ $# = 0 ] || shift
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(text field_file facets serve)
fuzz=$build/fuzz

say "Building the fuzz targets in $fuzz"
mkdir -p "$fuzz"
cmake -S . -B "$fuzz" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=None \
  -DCMAKE_CXX_FLAGS=-O1 -DMESHGROW_FUZZ=ON >"$fuzz/configure.log" ||
  fail "cmake failed: see $fuzz/configure.log"
cmake --build "$fuzz" -j2 || fail "the build failed."
export OMP_NUM_THREADS=1 # threads would only be in each other's way
rm -rf "$fuzz/seeds"
"$fuzz/bin/fuzz_seeds" "$fuzz/seeds"

# Prints a row of the table; false if something was found.
run() {
  local target=$1 log=$fuzz/$1.log found=$fuzz/found/$1 kept=tests/fuzz/found/$1
  local options=(-max_total_time="$seconds" -timeout=60 -report_slow_units=60
    -rss_limit_mb=1024 -malloc_limit_mb=64 -print_final_stats=1 -artifact_prefix="$found/")
  case $target in
  text) options+=(-max_len=400 -dict=tests/fuzz/text.dict) ;;
  field_file) options+=(-max_len=40000) ;;
  *) options+=(-max_len=2000) ;;
  esac
  local folders=("$fuzz/corpus/$target" "$fuzz/seeds/$target")
  [ ! -d "$kept" ] || folders+=("$kept")
  rm -rf "$found"
  mkdir -p "$found" "$fuzz/corpus/$target"
  "$fuzz/bin/fuzz_$target" "${options[@]}" "${folders[@]}" >"$log" 2>&1 || true
  local runs coverage findings
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  coverage=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
  findings=$(find "$found" -type f ! -name 'slow-unit-*' | wc -l)
  printf '%-12s %12s %10s %10s\n' "$target" "${runs:--}" "${coverage:--}" "$findings"
  # A target that did not get as far as its statistics has failed as well.
  [ "$findings" = 0 ] && [ -n "$runs" ]
}

say "Fuzzing, $seconds seconds each"
printf '%-12s %12s %10s %10s\n' target executions coverage findings
failed=()
for target in "${targets[@]}"; do
  run "$target" || failed+=("$target")
done

for target in ${failed[@]+"${failed[@]}"}; do
  printf '\n== %s: see %s\n' "$target" "$fuzz/$target.log"
  grep -m 3 -E 'Does not hold|runtime error|^SUMMARY|^==[0-9]+==ERROR' "$fuzz/$target.log" || true
  for file in "$fuzz/found/$target"/*; do
    [ ! -f "$file" ] || printf 'Again: OMP_NUM_THREADS=1 %s %s\n' "$fuzz/bin/fuzz_$target" "$file"
  done
done
[ ${#failed[@]} = 0 ]
