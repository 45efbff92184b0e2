#!/usr/bin/env bash
# Builds catena and runs its tests.
#
#   tests/run.sh           Release build, every test but the long ones (stress, fuzz, bench, browser)
#   tests/run.sh --all     also: a build by clang with AddressSanitizer and UndefinedBehaviorSanitizer in which the tests
#                          labelled quick run, and the format of the sources
#   tests/run.sh --long    only the long tests, a build by clang file by file, in which every header and every warning
#                          counts, and the fuzzers of the readers: CATENA_FUZZ_SECONDS each, 30 by default.
#                          The long ones make some 140,000 random scenes, or CATENA_STRESS_CASES of each kind
#
# Installs what is missing (apps/setup.sh). A stage that fails does not keep the later ones from running; the exit code
# is 0 only when all of them passed. Builds go to build/<preset>.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mode="${1:-}"
long=OFF
case "$mode" in
  "") packages=--tests ;;
  --long)
    packages=--all
    long=ON
    ;;
  --all) packages=--checks ;;
  *)
    echo "usage: tests/run.sh [--all | --long]" >&2
    exit 2
    ;;
esac

jobs="$(nproc)"
# BLAS threads gain nothing on the small fronts of these matrices and would compete with the tests that run at once.
export OPENBLAS_NUM_THREADS=1
export CTEST_OUTPUT_ON_FAILURE=1
summary=()
failures=0

# stage <name> <command...>: runs the command, keeps its outcome and time for the closing summary.
stage() {
  local name="$1" start=$SECONDS outcome=passed
  shift
  echo
  echo "=== $name"
  if ! "$@"; then
    outcome=FAILED
    failures=$((failures + 1))
  fi
  summary+=("$(printf '%-44s %-8s %5d s' "$name" "$outcome" $((SECONDS - start)))")
}

build() {
  local preset="$1"
  shift
  cmake --preset "$preset" "$@" && cmake --build "build/$preset" --parallel "$jobs"
}

run_ctest() {
  local preset="$1"
  shift
  ctest --test-dir "build/$preset" --parallel "$jobs" --timeout "${most_seconds:-600}" --no-tests=error "$@"
}

release_build() {
  build release -DCATENA_LONG_TESTS="$long" -DCATENA_BUILD_TESTS=ON -DCATENA_BUILD_BENCH=ON -DCATENA_WITH_PYTHON=ON \
    -DCATENA_WITH_MPI=AUTO
}
# Packages are unpacked by one processor. Where nothing is built yet, the library, which needs few of them, is compiled
# meanwhile; what is sought anew afterwards, MPI among it, changes none of its files.
packages_and_library() {
  if [[ -e build/release/build.ninja ]]; then
    apps/setup.sh "$packages"
    return
  fi
  apps/setup.sh || return 1
  local log status=0 others
  log="$(mktemp)"
  apps/setup.sh "$packages" >"$log" 2>&1 &
  others=$!
  trap 'kill "$others" 2>/dev/null; exit 130' INT TERM
  {
    cmake --preset release -DCATENA_BUILD_TESTS=OFF -DCATENA_BUILD_BENCH=OFF -DCATENA_WITH_MPI=OFF &&
      cmake --build build/release --parallel "$jobs" --target catena
  } || status=1
  wait "$others" || status=1
  trap - INT TERM
  cat "$log"
  rm -f "$log"
  return $status
}
release_tests() { run_ctest release --label-exclude '^(stress|fuzz|bench|browser)$'; }
long_tests() { most_seconds=3600 run_ctest release --label-regex '^(stress|fuzz|bench|browser)$'; }
# Reports name functions, and the line of undefined behaviour. Lines of every frame cost a tenth of the build; they come
# with `cmake --preset sanitize` where something was found.
sanitized_build() { build sanitize -DCMAKE_CXX_FLAGS_DEBUG=-g0; }
sanitized_tests() {
  ASAN_OPTIONS=detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1 run_ctest sanitize --label-regex '^quick$'
}
clang_build() { build clang; }
fuzzers_build() { cmake --preset fuzz && cmake --build build/fuzz --parallel "$jobs" --target fuzzers; }
fuzzers_run() {
  ctest --test-dir build/fuzz --timeout $((${CATENA_FUZZ_SECONDS:-30} + 120)) --no-tests=error --label-regex '^fuzz$'
}
format() {
  find lib apps tests \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
    xargs -0 -n 200 -P "$jobs" clang-format --dry-run --Werror &&
    echo "every source is formatted as .clang-format says"
}

if [[ "$mode" == --long ]]; then
  stage "Debian packages" apps/setup.sh "$packages"
  stage "Release build" release_build
  stage "long tests" long_tests
  stage "build by clang, file by file" clang_build
  stage "fuzzers by clang" fuzzers_build
  stage "fuzzing" fuzzers_run
else
  stage "Debian packages, the library" packages_and_library
  if [[ "$mode" == --all ]]; then
    stage "format" format
    stage "sanitized build by clang" sanitized_build
    stage "sanitized tests (label quick)" sanitized_tests
  fi
  stage "Release build" release_build
  stage "tests" release_tests
fi

echo
printf '%s\n' "${summary[@]}"
if [[ $failures -gt 0 ]]; then
  echo "$failures of ${#summary[@]} stages failed"
  exit 1
fi
echo "all ${#summary[@]} stages passed in $SECONDS s"
