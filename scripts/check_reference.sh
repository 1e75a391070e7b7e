#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the suite `quick` and compares it with results/reference/street. Exit code as of
# `raymoval compare`: 0 the same or better, 1 worse, 2 not comparable.
#
#   scripts/check_reference.sh
#   scripts/check_reference.sh --update   makes the run the reference: read what moved, and commit the file
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case ${1:-} in
  "" | --update) ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/check_reference.sh; exit 0 ;;
  *) echo "check_reference.sh: '$1' is unknown; expected --update or nothing." >&2; exit 2 ;;
esac

reference=results/reference/street
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
build/release/raymoval run benchmark/suites/quick.json --quiet --jobs "$(nproc)" --out "$out/run" >"$out/log.txt" 2>&1 ||
  { cat "$out/log.txt"; exit 1; }
status=0
build/release/raymoval compare "$out/run" "$reference" || status=$?
[[ -n ${1:-} ]] || exit $status
build/release/raymoval compare "$out/run" "$reference" --update
