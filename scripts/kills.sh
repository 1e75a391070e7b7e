#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Kills small commands at random moments, and checks what is left and how the same command goes on.
#
#   scripts/kills.sh [COUNT [SEED]]     default: 500 kills, seed 1
#
# Kill number N with one seed is always the same. Needs build/release/raymoval, python3 and perl;
# 500 take half an hour. tests/kills/kills.py says what is checked. The exit code is 1 if something
# does not hold.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/kills.sh; exit 0 ;;
esac
for number in "$@"; do
  [[ $number =~ ^[0-9]+$ ]] && continue
  echo "kills.sh: '$number' is no number." >&2
  exit 2
done
exec python3 tests/kills/kills.py build/release/raymoval "${1:-500}" "${2:-1}"
