#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A method that got slightly worse is found by the comparison that scripts/check_reference.sh makes,
# and the line says which method, on what, and in which rate.
# Usage: broken_method_test.sh PATH/TO/raymoval_faulty PATH/TO/SOURCES
set -uo pipefail
raymoval=$(readlink -f "$1")
sources=$(readlink -f "$2")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
reference=$sources/results/reference/street

# One in a hundred of the points that dufomap removes is lost.
FAULTY_SLIP=dufomap expect 0 "All controls have their expected scores" \
  run "$sources/benchmark/suites/quick.json" --quiet --out run
expect 1 "street / dufomap:offline, erasor: RR" compare run "$reference"
cp out.txt told.txt
holds "the rate is told before and after" \
  grep -qE '^  street / dufomap:offline, erasor: .*RR [0-9.]+ -> [0-9.]+ \(-[0-9.]+\)' told.txt
holds "by the other protocol too" \
  grep -qE '^  street / dufomap:offline, dynamicmap: .*DA [0-9.]+ -> [0-9.]+ \(-' told.txt
holds "no other method is blamed" test "$(grep -c '^  street' told.txt)" -eq 2
holds "all others are the same" grep -qE '^([0-9]+) of ([0-9]+) cells .*: worse\.$' told.txt
finish "broken method"
