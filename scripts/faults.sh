#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Lets the k-th call to the system fail, for every k and each kind of call (open, read, write, fsync,
# rename, stat, mmap, fork, malloc ...) of small commands (run, run resumed, clean, simulate, report,
# compare), and checks what becomes of them: the right files, or an error that is told; never a crash,
# a hang or half a file. Allocations are tried once for each chain of callers. Prints what was tried
# by command and call; the exit code is 1 if an outcome is bad. All of it takes an hour or two.
#
#   scripts/faults.sh                                 all of them
#   scripts/faults.sh --calls stat,rename             these calls only
#   scripts/faults.sh --commands clean --sample 20    20 of each kind of call of one command
#   scripts/faults.sh --jobs 4 --seconds 600          four at a time; nothing new after ten minutes
set -euo pipefail
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
esac
for ((i = 1; i <= $#; ++i)); do
  case ${!i} in
    --calls | --commands | --sample | --jobs | --seconds) i=$((i + 1)) ;;
    --places) ;;
    *) echo "faults.sh: '${!i}' is unknown; see --help." >&2; exit 2 ;;
  esac
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=build/release
cmake --preset release >/dev/null
cmake --build "$build" --target raymoval_program raymoval_fault_shim
exec python3 -B tests/faults/fault_campaign.py "$build/raymoval" "$build/tests/raymoval_fault_shim.so" "$@"
