#!/usr/bin/env bash
# Runs the tests under sanitizers: AddressSanitizer and UndefinedBehaviorSanitizer over those of
# core and plugin, ThreadSanitizer over what several threads may do at once. No function of ours is
# exempted. Arguments: parts to run (address, python, thread), all if there are none; `python-all`
# runs the Python tests that a usual run leaves out as well.
set -euo pipefail
cd "$(dirname "$0")/.."
without_build=1
with_checks=1
. tests/setup.sh

parts=("$@")
[ $# -gt 0 ] || parts=(address python thread)
address=$build/sanitize-address
thread=$build/sanitize-thread
summary=()
status=0

wants() { [[ " ${parts[*]} " == *" $1 "* ]]; }

# Seconds of processor time of all that ran and ended so far.
processor_time() {
  local fields
  read -ra fields <"/proc/$$/stat"
  echo $(((fields[15] + fields[16]) / $(getconf CLK_TCK)))
}

# build FOLDER KIND TARGET...: with the sanitizers of that kind.
build() {
  local folder=$1 kind=$2 began=$SECONDS before
  before=$(processor_time)
  shift 2
  say "Building with -DMESHGROW_SANITIZE=$kind in $folder"
  mkdir -p "$folder"
  ln -sfn ../venv "$folder/venv"
  cmake -S . -B "$folder" -G Ninja -DMESHGROW_SANITIZE="$kind" -DCMAKE_BUILD_TYPE= \
    >"$folder/configure.log" 2>&1 || fail "cmake failed: see $folder/configure.log"
  cmake --build "$folder" -j2 --target "$@" || fail "the build with sanitizers failed."
  tell passed "build: $kind" "$began" "$before"
}

# tell RESULT NAME BEGAN BEFORE: a line for the summary.
tell() {
  summary+=("$1  $2 ($((SECONDS - $3)) s, $(($(processor_time) - $4)) s of processor time)")
}

# check NAME COMMAND...: runs it, and keeps its result for the summary.
check() {
  local name=$1 began=$SECONDS result=passed before
  before=$(processor_time)
  shift
  say "$name"
  "$@" || { result=FAILED; status=1; }
  tell "$result" "$name" "$began" "$before"
}

# halves PROGRAM [ARGUMENT...]: a GoogleTest program as two processes.
halves() {
  local failed=0 shard
  for shard in 0 1; do
    GTEST_TOTAL_SHARDS=2 GTEST_SHARD_INDEX=$shard GTEST_BRIEF=1 "$@" &
  done
  wait -n || failed=1
  wait -n || failed=1
  return $failed
}

# Whether ThreadSanitizer, OpenMP and Archer work together here.
tells_races() {
  local program=$thread/race_on_purpose
  clang++ -O1 -g1 -fsanitize=thread -fopenmp tests/threads/race_on_purpose.cpp -o "$program"
  local told=0
  "$program" 2>"$program.log" || told=$?
  [ "$told" = 66 ] && grep -q 'data race' "$program.log" && "$program" in-turns
}

export UBSAN_OPTIONS=print_stacktrace=1
# Threads that wait leave the processor to the other process.
export OMP_WAIT_POLICY=passive
# The trees of facets and all that stands on them, by each of the instruction sets that the
# processor has; the fastest is the one without a name.
kernels=(plain avx2)

if wants address; then
  build "$address" address core_tests plugin_tests thread_tests linked_program cpp_program_newest
  # What libgmsh, its C++ functions over C and the libraries below it do not free is theirs.
  printf 'leak:%s\n' libgmsh gmsh::model::mesh::setSizeCallback libTK libfontconfig \
    >"$address/leaks-of-others"
  export LSAN_OPTIONS=suppressions=$address/leaks-of-others:print_suppressions=0
  export ASAN_OPTIONS=detect_stack_use_after_return=1
  # Checks make these slow, and others run the same code: minutes of many facets and systems.
  long_ones='BackgroundGrid.ManySmallFacets*:BackgroundGrid.KeepsItsPromises*'
  long_ones+=':BackgroundGrid.IsTheSameToTheBit*:BackgroundGrid.GrowthRateOneAmongOthers'
  long_ones+=':Tolerances/*/2_percent:Tolerances/*/5_percent'
  long_ones+=':*FacetTreeOf.SizeEqualsBruteForce/mixed:*FacetTreeOf.SizeEqualsBruteForce/triangles'
  long_ones+=':FacetTree.SizeEqualsBruteForceForAnyNumber*:FacetTree.TenThousandIdenticalFacets'
  long_ones+=':Facet.DistanceEqualsTheReference*:IntervalMatching.SystemsOfSidesOfSeveral*'
  long_ones+=':IntervalMatching.ADemandThatGrows*:ProximityStartSizes.TruncatedWedge*'
  long_ones+=':MeshingPlan.RandomModels*'
  check "address: core" halves "$address/bin/core_tests" --gtest_filter="-$long_ones"
  for simd in "${kernels[@]}"; do
    check "address: core, $simd kernels" env MESHGROW_SIMD="$simd" GTEST_BRIEF=1 \
      "$address/bin/core_tests" \
      --gtest_filter="FacetTree.*:SmallestSizes*:BackgroundGrid.*-$long_ones"
  done
  for libgmsh in "$libgmsh_debian" "$libgmsh_newest"; do
    export MESHGROW_GMSH_LIB=$libgmsh GTEST_BRIEF=1
    check "address: plugin, ${libgmsh##*/}" "$address/bin/plugin_tests"
    check "address: threads, ${libgmsh##*/}" "$address/bin/thread_tests"
  done
  unset MESHGROW_GMSH_LIB GTEST_BRIEF
  for program in linked_program cpp_program_newest; do
    check "address: $program" "$address/bin/$program"
  done
fi

if wants python || wants python-all; then
  build "$address" address meshgrow meshgrow_program
  # Python, Gmsh and what they load are as they are: only our library and program are checked, from
  # within, and nobody's leaks are counted. A usual run takes what fails, is cut off, damaged or
  # odd, and what hands out memory of ours.
  chosen='failing_passes|interrupted_passes|gmsh_faults|bad_input|odd_[a-z]+|lifecycle'
  chosen+='|premeshed_entities|mapped_surfaces|kinds_of_entities|sizes|views|arrays|saved_fields'
  chosen+='|serve|program|probe|report'
  chosen="^python\\.((debian|newest)\\.test_($chosen)|newest\\.test_size_callback)\$"
  ! wants python-all || chosen='^python\.'
  runtime="$(g++ -print-file-name=libasan.so) $(g++ -print-file-name=libstdc++.so)"
  check "address: Python" env ASAN_OPTIONS=detect_leaks=0 LD_PRELOAD="$runtime" \
    ctest --test-dir "$address" -j2 --output-on-failure -R "$chosen"
fi

if wants thread; then
  # GCC's OpenMP tells ThreadSanitizer nothing; Clang's does, through Archer.
  CXX=clang++ build "$thread" thread core_tests thread_tests
  archer=$(ls /usr/lib/llvm-*/lib/libarcher.so | tail -n 1)
  export OMP_TOOL_LIBRARIES=$archer GTEST_BRIEF=1
  # Gmsh is not instrumented: what it does between locks that cannot be seen is left alone.
  export TSAN_OPTIONS=ignore_noninstrumented_modules=1:halt_on_error=1
  check "thread: a race on purpose is told, turns are not" tells_races
  check "thread: core" "$thread/bin/core_tests" --gtest_filter='*Thread*:ParallelFor.*'
  for simd in "${kernels[@]}"; do
    check "thread: evaluation and building, $simd kernels" env MESHGROW_SIMD="$simd" \
      "$thread/bin/thread_tests" --gtest_filter='*Evaluation*:Building.*'
  done
  for libgmsh in "$libgmsh_debian" "$libgmsh_newest"; do
    check "thread: all, ${libgmsh##*/}" env MESHGROW_GMSH_LIB="$libgmsh" \
      "$thread/bin/thread_tests"
  done
fi

say "Sanitizers"
printf '%s\n' "${summary[@]}"
exit $status
