#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Everything that has to hold before a change is merged. Goes on after a failure. At the end it shows
# the last 30 lines of whatever failed, then the names of all that failed, and in the last line
# "N passed, N failed". The exit code is 1 if anything failed.
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

logs=$(mktemp -d)
: >"$logs/failures"

# count NAME STATUS LOG: one check more, and what it printed.
count() {
  if [[ $2 -eq 0 ]]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    failures+=("$1")
    { echo "== failed: $1"; tail -n 30 "$3"; } >>"$logs/failures"
  fi
}

# title NAME: tells the seconds since the script began, too, so that a log shows what takes long.
title() {
  echo "== $1 (after $SECONDS s)"
}

# step NAME COMMAND...: one check that counts as one.
step() {
  title "$1"
  "${@:2}" 2>&1 | tee "$logs/step"
  count "$1" "${PIPESTATUS[0]}" "$logs/step"
}

# begin COMMAND...: runs beside what follows, in a process group of its own, which ends with this
# script. finish NAME: waits for it, shows what it printed, and counts it. What follows comes first, but
# for an installation, which would hardly begin beside a compiler.
beside=
installs=
begin() {
  set -m
  ([[ -n $installs ]] || renice -n 10 "$BASHPID" >/dev/null; "$@") >"$logs/beside" 2>&1 </dev/null &
  beside=$!
  set +m
}
finish() {
  title "$1"
  wait "$beside"
  local status=$?
  beside=
  cat "$logs/beside"
  count "$1" $status "$logs/beside"
}
# end_beside: an installation is waited for, for one that is broken off leaves packages half there.
end_beside() {
  [[ -n $beside ]] || return 0
  if [[ -n $installs ]]; then wait "$beside"; else kill -- "-$beside" 2>/dev/null; fi
}
trap 'end_beside; rm -rf "$logs"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

# run_tests PRESET [OPTION...]: counts every test of ctest, and each test case where one process runs
# several.
run_tests() {
  local build=build/$1 status total=0 bad=0
  title "tests, $1"
  rm -f "$build"/Testing/Temporary/LastTestsFailed.log "$build/junit.xml"
  ctest --preset "$1" "${@:2}" --output-junit "$PWD/$build/junit.xml" 2>&1 | tee "$build/ctest.log"
  status=${PIPESTATUS[0]}
  if [[ -e $build/junit.xml ]]; then
    read -r total bad < <(python3 scripts/test_results.py "$build" "$build/junit.xml" "$logs/failures")
  fi
  if [[ $total -eq 0 || ( $status -ne 0 && $bad -eq 0 ) ]]; then
    count "tests, $1" 1 "$build/ctest.log"
    return
  fi
  passed=$((passed + total - bad))
  failed=$((failed + bad))
  [[ $bad -eq 0 ]] || failures+=("$(sed "s/^[0-9]*:/tests, $1: /" "$build"/Testing/Temporary/LastTestsFailed.log)")
}

# Ninja would start more compilers than there are processors, which takes more of their time.
build() {
  cmake --preset "$1" "${@:2}" && cmake --build --preset "$1" --parallel "$(nproc)"
}

check_format() {
  if ! command -v clang-format >/dev/null; then
    echo "clang-format is not there; formatting is not checked."
    return 0
  fi
  git ls-files '*.h' '*.cpp' | xargs -P 2 -n 100 clang-format --dry-run --Werror
}

step "dependencies of the build" scripts/install_dependencies.sh --python
# What only tests need is unpacked while the compiler works.
installs=yes
begin scripts/install_dependencies.sh --tests
step "includes" scripts/check_includes.sh
step "own includes" scripts/check_own_includes.py
step "tree" scripts/check_tree.sh
step "format" check_format
step "release build" build release -DRAYMOVAL_WERROR=ON -DRAYMOVAL_REPORT_3D=ON -DRAYMOVAL_PYTHON=ON \
  -DRAYMOVAL_CASES_AT_ONCE=24 "-DRAYMOVAL_ONLY_SPARED=datasets;simulated;methods;eval;benchmark"
finish "dependencies of the tests"
installs=
step "programs that only tests need are found" cmake build/release
# The release tests leave much of the processors idle. Cases that both builds would run are left to
# the sanitizers, but for those of core, which are soon done, and of code for several instruction sets.
# That each parameter acts is the same whatever it is compiled for, and takes long.
begin build asan-ubsan -DRAYMOVAL_TEST_OBJECTS="$PWD/build/release" \
  -DRAYMOVAL_HARNESS_OBJECTS="$PWD/build/release"
run_tests release -E 'parameters act when they are said to$'
step "reference results" scripts/check_reference.sh
finish "sanitizer build"
scripts/coverage.sh --reset
run_tests asan-ubsan -E '^cli'  # Those start the program hundreds of times: scripts/coverage.sh --run.
step "coverage" scripts/coverage.sh

title "end"
cat "$logs/failures"
[[ ${#failures[@]} -eq 0 ]] || printf '%s\n' "${failures[@]}" | sed 's/^/failed: /'
echo "$passed passed, $failed failed"
[[ $failed -eq 0 ]]
