#!/usr/bin/env bash
# The checks beside the tests: clang-tidy, the tests under sanitizers, and half a minute of fuzzing
# each. All are run, whatever the ones before found.
set -uo pipefail
cd "$(dirname "$0")"
failed=()
./tidy.sh || failed+=(tidy.sh)
./sanitizers.sh || failed+=(sanitizers.sh)
./fuzz.sh 30 || failed+=(fuzz.sh)
if [ ${#failed[@]} -gt 0 ]; then
  printf '\nThese checks failed, see above: %s\n' "${failed[*]}" >&2
  exit 1
fi
printf '\nclang-tidy, sanitizers and fuzzing found nothing\n'
