#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Which share of each room's lines and branches the tests run, as gcov counted it while the tests of
# build/asan-ubsan ran (branches of thrown exceptions are left out). The exit code is 1 if core,
# datasets, eval or the stores are below 90 % of lines. After scripts/test.sh little more of benchmark is
# counted than the stores.
#
#   scripts/coverage.sh [FILE...]      also tells which lines of these files did not run
#   scripts/coverage.sh --run          first builds everything with the sanitizers, and runs all tests
#                                      of that build
#   scripts/coverage.sh --reset        forgets what was counted
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/asan-ubsan
reset() { [[ ! -d $build ]] || find "$build" -name '*.gcda' -delete; }
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/coverage.sh; exit 0 ;;
  --reset) reset; exit 0 ;;
  --run)
    cmake --preset asan-ubsan
    cmake --build --preset asan-ubsan
    reset
    ctest --preset asan-ubsan
    shift ;;
  -*) echo "coverage.sh: '$1' is unknown; expected files, --reset or nothing." >&2; exit 2 ;;
esac
exec python3 scripts/coverage.py "$build" "$@"
