#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Mutation testing: plants small faults in the code that decides numbers, one at a time, and tells
# which of them no test finds. Needs clang's syntax tree (Debian: python3-clang-14).
#
#   scripts/mutate.sh [--room ROOM] [--file FILE ...] [--sample N] [--seed S] [--jobs N]
#                     [--tests SPEC] [--survivors] [--unexplained] [--list]
#
#   --room       eval (default), readers, stores or raymoval
#   --file       only this file of the room
#   --sample     only so many mutants, chosen by --seed (default 1); all of them otherwise
#   --tests      only test cases that Catch2 chooses by this, such as "[averages]"
#   --survivors  only those that no test found in earlier runs, and those not tried yet: after
#                writing a test, or after a run that was stopped; the score is that of all
#   --unexplained  not those that tests/mutants/equivalent.md explains, which are tried in vain for
#                longest; they are taken to survive
#   --list       only tells the mutants
#
# All mutants of a room are compiled into its test programs at once, each behind a switch that is
# read when the program runs. A mutant meets the test cases that reach it, the quick ones first, up
# to the first failure; one that needs much more time than the tests alone counts as found.
# Survivors that change nothing are explained in tests/mutants/equivalent.md, which is subtracted.
# The exit code is 1 if fewer mutants are found than the room wants (scripts/mutants/rooms.py).
set -euo pipefail
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
esac
# Debian's Python has the module; another one may come first in the path.
exec /usr/bin/python3 "$(dirname "${BASH_SOURCE[0]}")/mutants/mutate.py" "$@"
