#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs dependencies, builds, and runs the tests. It continues after a failure; the last line is
# "N passed, N failed". Before a change is merged, run scripts/test.sh and then scripts/test.sh --all.
#
#   scripts/test.sh         builds with -O2, and runs all unit tests, the tests of the commands, and the
#                           comparison with the recorded results
#   scripts/test.sh --all   builds and runs the same tests with AddressSanitizer and UBSan, measures
#                           coverage, and tests the site, LaTeX, reports in a browser, Python and packages
#   RAYMOVAL_PCL=OFF        builds without PCL, which is then not installed
#   scripts/test.sh --all --quick   leaves out tests with the label slow in the sanitizers' build
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1

all=
pcl=${RAYMOVAL_PCL:-ON}
sanitized='extra'
for argument in "$@"; do
  case $argument in
    --all) all=yes ;;
    --quick) sanitized='extra|slow' ;;
    -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/test.sh; exit 0 ;;
    *) echo "test.sh: '$argument' is unknown; expected --all, --all --quick or nothing." >&2; exit 2 ;;
  esac
done

passed=0
failed=0
failures=()

# step NAME COMMAND...: a check that counts as one. Its title has the seconds since the script began.
step() {
  echo "== $1 (after $SECONDS s)"
  if "${@:2}"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    failures+=("$1")
  fi
}

# build PRESET [OPTION...]. Ninja itself would start more compilers than there are processors.
build() {
  cmake --preset "$1" "${@:2}" && cmake --build --preset "$1" --parallel "$(nproc)"
}

# run_tests PRESET [OPTION...]: each test of ctest counts.
run_tests() {
  local counts junit=$PWD/build/$1/junit.xml
  rm -f "$junit"
  echo "== tests, $1 (after $SECONDS s)"
  ctest --preset "$1" --parallel "$(nproc)" --output-junit "$junit" "${@:2}"
  local status=$?
  counts=$(sed -nE '/<testsuite /,/>/{s/.*(tests|failures)="([0-9]+)".*/\1=\2/p}' "$junit" 2>/dev/null)
  local tests=0 bad=1
  [[ $counts =~ tests=([0-9]+) ]] && tests=${BASH_REMATCH[1]}
  [[ $counts =~ failures=([0-9]+) ]] && bad=${BASH_REMATCH[1]}
  [[ $status -eq 0 || $bad -gt 0 ]] || bad=1
  passed=$((passed + tests - (tests > 0 ? bad : 0)))
  failed=$((failed + bad))
  [[ $bad -eq 0 ]] && return
  failures+=("tests, $1: $(sed -nE 's/.*<testcase name="([^"]*)".*status="fail".*/\1/p' "$junit" 2>/dev/null |
    head -n 20 | paste -sd ';')")
}

# Lines that the tests of the sanitizers' build ran, by gcovr, in build/coverage/ROOM.html.
check_coverage() {
  local limit room status=0
  mkdir -p build/coverage
  # Counts that two threads change at once may become negative, which gcovr takes for an error.
  gcovr --root . --object-directory build/asan-ubsan -j "$(nproc)" --exclude-throw-branches \
    --gcov-ignore-parse-errors --json build/coverage/counts.json build/asan-ubsan 2>build/coverage/log.txt ||
    { tail -n 20 build/coverage/log.txt; return 1; }
  for limit in core:90 datasets:90 methods:95 eval:95 benchmark:85; do  # Percent of lines.
    room=${limit%:*}
    echo "$room, at least ${limit#*:} %:"
    gcovr --root . --add-tracefile build/coverage/counts.json --filter "$room/" \
      --html-details "build/coverage/$room.html" --fail-under-line "${limit#*:}" --print-summary \
      >build/coverage/summary.txt || status=1
    grep -E '^(lines|branches):' build/coverage/summary.txt
  done
  return $status
}

check_format() {
  git ls-files '*.h' '*.cpp' | xargs -P "$(nproc)" -n 100 clang-format --dry-run --Werror
}

if [[ -z $all ]]; then
  step "dependencies" scripts/install_dependencies.sh --tests
  step "includes" scripts/check_includes.sh
  step "tree" scripts/check_tree.sh
  step "format" check_format
  step "build" build release -DRAYMOVAL_WERROR=ON -DRAYMOVAL_PCL="$pcl"
  run_tests release --label-exclude extra
  step "reference results" scripts/check_reference.sh
else
  step "dependencies" scripts/install_dependencies.sh --all
  step "build" build release -DRAYMOVAL_WERROR=ON -DRAYMOVAL_PCL="$pcl" -DRAYMOVAL_PYTHON=ON
  run_tests release --label-regex extra
  step "sanitizer build" build asan-ubsan -DRAYMOVAL_PCL="$pcl"
  find build/asan-ubsan -name '*.gcda' -delete
  run_tests asan-ubsan --label-exclude "$sanitized"
  step "coverage" check_coverage
fi

echo "== end (after $SECONDS s)"
[[ ${#failures[@]} -eq 0 ]] || printf 'failed: %s\n' "${failures[@]}"
echo "$passed passed, $failed failed"
[[ $failed -eq 0 ]]
