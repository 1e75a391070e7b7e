#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Damages whole sequences at random (bytes, sizes, names, numbers in texts) in each layout, and gives
# them to `raymoval inspect`, `run`, `clean` and `score`, with limits on time and memory.
#
#   scripts/fuzz_sequences.sh [COUNT [SEED [PROGRAM]]]
#       default: 500 sequences, seed 1, build/release/raymoval
#
# The outcome of each command has to be exit code 0 with finite numbers, or 1 or 2 with a message;
# and data on which a cell fails has to give a finding of `inspect`. The same seed gives the same
# sequences. What fails is kept in build/fuzz_sequences/SEED-NUMBER, and then the exit code is 1.
# SANITIZERS=1 is for a program with the sanitizers: it takes more memory and time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/fuzz_sequences.sh; exit 0 ;;
esac
count=${1:-500}
seed=${2:-1}
program=${3:-build/release/raymoval}
if ! [[ $count =~ ^[1-9][0-9]*$ && $seed =~ ^[0-9]+$ ]]; then
  echo "fuzz_sequences.sh: '$count' and '$seed' have to be a count and a seed." >&2
  exit 2
fi
[[ -x $program ]] || { echo "fuzz_sequences.sh: build $program first." >&2; exit 2; }
exec python3 tests/fuzz/sequences.py "$program" "$count" "$seed" build/fuzz_sequences
