#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Appends to results/history/MACHINE.jsonl what the methods of this commit score: one line for each
# method on each scene, with counts, rates, the hash of the masks, and the time of the method as a
# multiple of the time of a fixed kernel. Lines are only added; what is recorded already stays.
#
#   scripts/record.sh                              builds this commit and records it; the tree must be clean
#   scripts/record.sh --program FILE --commit REV  records a program that was built from another commit
#   scripts/record.sh --reference REV...           records what results/reference/street was at these commits:
#                                                  counts without times, and nothing is built or run
#     --machine NAME   name of this machine in the history (default: its processor)
#     --rounds N       how often times are taken; 0 takes none (default: 3)
#     --out DIR        where the files are (default: results/history)
#
# Scenes and methods are those of the suites `quick` and `simulated-quick`, as far as the program has
# them; times are taken on `street`, with one thread. It takes a few minutes. `raymoval history` shows
# what changed. docs/history.md says what a line holds.
# Exit codes: 0 recorded, 1 the same commit gave another answer than before, 2 cannot be done.
set -euo pipefail
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
esac
exec python3 -B "$(dirname "${BASH_SOURCE[0]}")/record.py" "$@"
