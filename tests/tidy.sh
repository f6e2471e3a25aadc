#!/usr/bin/env bash
# Checks all C++ with clang-tidy and .clang-tidy, on two cores; every finding is an error.
#
#   tests/tidy.sh                      everything, in build/tidy: about five minutes
#   tests/tidy.sh src/size_field.cpp   these files only
set -euo pipefail
cd "$(dirname "$0")/.."
with_checks=1
with_benchmarks=1
without_build=1
. tests/setup.sh

tidy=$build/tidy
batches=$tidy/batches
mkdir -p "$tidy"
ln -sfn "$build/venv" "$tidy/venv"
# Configured for clang, never built.
say "Checking with clang-tidy in $tidy"
cmake -S . -B "$tidy" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_COMPILER_LAUNCHER= \
  >"$tidy/configure.log" 2>&1 || fail "cmake failed: see $tidy/configure.log"
"$python_debian" tests/tidy_batches.py . "$tidy" "$@"

# The findings of one file; a crash of clang-tidy is one, too.
check_file() {
  local status=0 findings
  findings=$(clang-tidy --quiet -p "$batches" "$@" 2>/dev/null) || status=$?
  [ -z "$findings" ] || printf '%s\n' "$findings"
  [ $status = 0 ] || grep -q 'error: ' <<<"$findings" ||
    printf '%s: error: clang-tidy ended with status %d\n' "${*: -1}" $status
}

# Reads a few files as one; where they do not go together, one by one.
check() {
  local list=$1
  local together=${list%.list}.cpp findings=${list%.list}.txt file
  if [ -e "$together" ]; then
    check_file --checks=-bugprone-suspicious-include "$together" >"$findings"
    grep -qE 'clang-diagnostic-error|error: clang-tidy ended' "$findings" || return 0
  fi
  while read -r file; do
    check_file "$file"
  done <"$list" >"$findings"
}
export -f check_file check
export batches
printf '%s\n' "$batches"/*.list | xargs -P2 -I{} bash -c 'check {}'

cat "$batches"/*.txt
files=$(cat "$batches"/*.list | wc -l)
# A finding in a header is told by every file that includes it.
findings=$(cat "$batches"/*.txt | sort -u | grep -cE '(warning|error): ' || true)
printf '\nclang-tidy: %d files, %d findings\n' "$files" "$findings"
[ "$findings" = 0 ]
