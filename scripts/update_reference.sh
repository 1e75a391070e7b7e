#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes results/reference/street/results.json anew: what scripts/check_reference.sh compares with.
# Run it after a change that is meant to alter results, read what moved, commit the file with it.
#
#   scripts/update_reference.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case ${1:-} in
  "") ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/update_reference.sh; exit 0 ;;
  *) echo "update_reference.sh: '$1' is unknown; expected nothing." >&2; exit 2 ;;
esac

cmake --preset release
cmake --build --preset release --target raymoval_program
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
build/release/raymoval run benchmark/suites/quick.json --out "$out/run"

reference=results/reference/street
if [[ -e $reference/results.json ]]; then
  echo "== what changes"
  build/release/raymoval compare "$out/run" "$reference" || true
fi
build/release/raymoval compare "$out/run" "$reference" --update
