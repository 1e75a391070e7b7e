#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Which lines of each room the tests of the build asan-ubsan ran, as gcovr reads it from that build, in
# build/coverage/ROOM.html. The exit code is 1 if a room is below its limit.
#
#   scripts/coverage.sh     after scripts/test.sh --all
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
case ${1:-} in
  "") ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/coverage.sh; exit 0 ;;
  *) echo "coverage.sh: '$1' is unknown; expected nothing." >&2; exit 2 ;;
esac

# Percent of lines. Much of benchmark is run by tests with the label slow.
limits="core:90 datasets:90 methods:95 eval:95 benchmark:85"

build=build/asan-ubsan
[[ -n $(find "$build" -name '*.gcda' -print -quit 2>/dev/null) ]] ||
  { echo "coverage.sh: $build has no counts; run scripts/test.sh --all first." >&2; exit 2; }
mkdir -p build/coverage
# Counts that two threads change at once may become negative, which gcovr takes for an error.
gcovr --root . --object-directory "$build" -j "$(nproc)" --exclude-throw-branches \
  --gcov-ignore-parse-errors --json build/coverage/counts.json "$build" 2>build/coverage/log.txt ||
  { tail -n 20 build/coverage/log.txt; exit 1; }
status=0
for limit in $limits; do
  room=${limit%:*}
  echo "$room, at least ${limit#*:} %:"
  gcovr --root . --add-tracefile build/coverage/counts.json --filter "$room/" \
    --html-details "build/coverage/$room.html" --fail-under-line "${limit#*:}" --print-summary \
    >build/coverage/summary.txt || status=1
  grep -E '^(lines|branches):' build/coverage/summary.txt
done
exit $status
