#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the quick suite and compares it with results/reference/street. Exit code as of
# `raymoval compare`: 0 the same or better, 1 worse, 2 not comparable.
#
#   scripts/check_reference.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case ${1:-} in
  "") ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/check_reference.sh; exit 0 ;;
  *) echo "check_reference.sh: '$1' is unknown; expected nothing." >&2; exit 2 ;;
esac

reference=results/reference/street
if [[ ! -e $reference/results.json ]]; then
  echo "check_reference.sh: $reference/results.json is missing; make it with scripts/update_reference.sh" >&2
  exit 2
fi
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
build/release/raymoval run benchmark/suites/quick.json --quiet --jobs "$(nproc)" --out "$out/run" >"$out/log.txt" 2>&1 ||
  { cat "$out/log.txt"; exit 1; }
build/release/raymoval compare "$out/run" "$reference"
