#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Arrows between rooms point one way: core <- datasets, methods, eval <- benchmark.
#
#   scripts/check_includes.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case ${1:-} in
  "") ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/check_includes.sh; exit 0 ;;
  *) echo "check_includes.sh: '$1' is unknown; expected nothing." >&2; exit 2 ;;
esac

bad=0
# check ROOM FORBIDDEN...: no file of ROOM may include from a forbidden room.
check() {
  local room=$1
  shift
  local forbidden
  forbidden=$(IFS='|'; echo "$*")
  if grep -rnE "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]($forbidden)/" "$room" \
       --include='*.h' --include='*.cpp'; then
    echo "check_includes.sh: $room/ must not include from: $*" >&2
    bad=1
  fi
}
check core datasets methods eval benchmark
check datasets methods eval benchmark
check methods datasets eval benchmark
check eval datasets methods benchmark
[[ $bad -eq 0 ]] && echo "check_includes.sh: all includes point the right way."
exit $bad
