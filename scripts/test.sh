#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Everything that has to hold before a change is merged. Goes on after a failure; the last line is
# "N passed, N failed", and the exit code is 1 if anything failed.
#
#   scripts/test.sh        installs what the tests need first
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1

case ${1:-} in
  "") ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/test.sh; exit 0 ;;
  *) echo "test.sh: '$1' is unknown; expected nothing." >&2; exit 2 ;;
esac

passed=0
failed=0
failures=()

# count NAME STATUS: one check more.
count() {
  if [[ $2 -eq 0 ]]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    failures+=("$1")
  fi
}

# step NAME COMMAND...: one check that counts as one.
step() {
  echo "== $1"
  "${@:2}"
  count "$1" $?
}

# begin COMMAND...: runs beside what follows, at a lower priority and in a process group of its own,
# which ends with this script. finish NAME: waits for it, shows what it printed, and counts it.
beside=
begin() {
  set -m
  (renice -n 10 "$BASHPID" >/dev/null; "$@") >"$log_beside" 2>&1 </dev/null &
  beside=$!
  set +m
}
finish() {
  echo "== $1"
  wait "$beside"
  local status=$?
  beside=
  cat "$log_beside"
  count "$1" $status
}
log_beside=$(mktemp)
trap '[[ -z $beside ]] || kill -- "-$beside" 2>/dev/null; rm -f "$log_beside"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# run_tests PRESET: counts every test of ctest.
run_tests() {
  local log=build/$1/ctest.log
  echo "== tests, $1"
  ctest --preset "$1" 2>&1 | tee "$log"
  local status=${PIPESTATUS[0]} summary total bad
  # "97% tests passed, 1 tests failed out of 40"
  summary=$(grep -E 'tests passed, [0-9]+ tests failed out of [0-9]+' "$log" | tail -1)
  total=$(sed -nE 's/.*out of ([0-9]+).*/\1/p' <<<"$summary")
  bad=$(sed -nE 's/.*, ([0-9]+) tests failed.*/\1/p' <<<"$summary")
  if [[ -z $total || $total -eq 0 || ( $status -ne 0 && $bad -eq 0 ) ]]; then
    total=1
    bad=1
  fi
  passed=$((passed + total - bad))
  failed=$((failed + bad))
  [[ $bad -eq 0 ]] || failures+=("tests, $1")
}

build() {
  cmake --preset "$1" "${@:2}" && cmake --build --preset "$1"
}

check_format() {
  if ! command -v clang-format >/dev/null; then
    echo "clang-format is not there; formatting is not checked."
    return 0
  fi
  git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
}

step "dependencies" scripts/install_dependencies.sh --tests
step "includes" scripts/check_includes.sh
step "tree" scripts/check_tree.sh
step "format" check_format
step "release build" build release -DRAYMOVAL_WERROR=ON -DRAYMOVAL_REPORT_3D=ON -DRAYMOVAL_UNITY=benchmark
# The release tests leave much of the processors idle.
begin build asan-ubsan -DRAYMOVAL_TEST_OBJECTS="$PWD/build/release"
run_tests release
step "reference results" scripts/check_reference.sh
finish "sanitizer build"
scripts/coverage.sh --reset
run_tests asan-ubsan
step "coverage" scripts/coverage.sh

[[ ${#failures[@]} -eq 0 ]] || printf 'failed: %s\n' "${failures[@]}"
echo "$passed passed, $failed failed"
[[ $failed -eq 0 ]]
