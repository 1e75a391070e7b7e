#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Compares what the program scores with scorers in plain Python (tests/opinion), count by count: on
# sequences that are hard to score, on the built-in street, and on a few scans of each simulated
# scene with removals at random. It takes about ten minutes; ctest runs a small part.
#
#   scripts/second_opinion.sh                  all of it
#   scripts/second_opinion.sh town highway     only these scenes
#   scripts/second_opinion.sh FOLDER 0:20:5    some frames of a sequence in SemanticKITTI layout
#
# The program is build/release/raymoval, or what RAYMOVAL says.
set -euo pipefail

case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
  -*) echo "second_opinion.sh: '$1' is unknown; see --help." >&2; exit 2 ;;
esac
cd "$(dirname "${BASH_SOURCE[0]}")/.."
raymoval=${RAYMOVAL:-build/release/raymoval}
if [[ ! -x $raymoval ]]; then
  echo "second_opinion.sh: there is no program $raymoval; build it, or say where it is with RAYMOVAL." >&2
  exit 2
fi
opinion=(python3 tests/opinion/second_opinion.py "$raymoval")
failures=0

check() {
  "${opinion[@]}" "$@" || failures=$((failures + 1))
}

if [[ $# -eq 2 && -d $1 ]]; then
  check folder "$1" "$2"
else
  known="town highway country suburb crossing excavator"
  scenes=("$@")
  for scene in "${scenes[@]}"; do
    [[ " $known " == *" $scene "* ]] || {
      echo "second_opinion.sh: '$scene' is unknown; expected some of: $known." >&2
      exit 2
    }
  done
  if [[ $# -eq 0 ]]; then
    check hostile
    check street 10:25:5
    read -ra scenes <<<"$known"
  fi
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  for scene in "${scenes[@]}"; do
    "$raymoval" simulate "$scene" -o "$work/$scene" --scans 40 --quiet
    check folder "$work/$scene" 12:36:8
    rm -rf "${work:?}/$scene"
  done
fi
if [[ $failures -ne 0 ]]; then
  echo "second_opinion.sh: $failures of the comparisons differ." >&2
  exit 1
fi
echo "second_opinion.sh: all counts are the same."
