#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A method that crashes, hangs or leaks is one failed cell, and the other cells run.
# Usage: isolation_test.sh PATH/TO/raymoval_faulty
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

short=(--sequence street --frames 0:2 --quiet --threads 1)

# cell NAME STATUS REASON TAIL: what is stored of a method.
cell() {
  local file=run/cells/street/$1-default/cell.json
  holds "$1 is '$2'" grep -qF "\"status\": \"$2\"" "$file"
  holds "$1 says '$3'" grep -qE "\"reason\": \".*$3" "$file"
  holds "$1 printed '$4'" grep -qF "$4" "$file"
  holds "$1 has a row" grep -q "^street,$1,default,erasor,$2,,,,,,,,,,,,,,,$1:default\$" run/results.csv
}

# The limits are far above what the good methods need, and above each other's reach: what leaks
# does so at about 4 GiB a second.
methods=()
for method in crash abort quit quit7 hang stray leak leak-child killed throw comb; do
  methods+=(--method "$method")
done
expect 1 "cell failed: street / crash:default: crashed: signal 11" run "${short[@]}" \
  "${methods[@]}" --time-limit 6 --memory-limit 600 --out run
cp run/table.md table.txt
cell crash failed "crashed: signal 11 \(Segmentation fault\)" "the last words"
cell abort failed "crashed: signal 6 \(Aborted\)" "line 99999"
cell quit failed "gave no readable answer|ended with exit code" '"output_tail": "'
cell quit7 failed "exit code 7" '"output_tail": ""'
cell hang timeout "did not finish within 6 s" '"output_tail": ""'
cell stray timeout "did not finish within 6 s" '"output_tail": ""'
cell leak out_of_memory "used more than 600 MiB" "about to leak"
cell leak-child out_of_memory "used more than 600 MiB" "about to leak"
cell killed failed "killed from outside" '"output_tail": ""'
cell throw failed "no idea" '"output_tail": ""'
holds "of much output the end is kept" test "$(grep -o 'line [0-9]*' \
  run/cells/street/abort-default/cell.json | wc -l)" -lt 500
holds "the good method has a score" grep -q "^street,comb,default,erasor,ok,[0-9]" run/results.csv
holds "its memory is its own" awk -F, '$2 == "comb" { exit !($19 > 0 && $19 < 600) }' run/results.csv
holds "the table tells what failed" grep -qE "crash:default .*signal 11.*the last words" table.txt
holds "nothing that was started is left" test -z "$(left_over)"
holds "no lock is left" test ! -e run/run.lock
holds "no core file is left" test -z "$(find . -name 'core*')"

# A limit below a second is reported as given.
expect 1 "hang:default: did not finish within 0.2 s" run "${short[@]}" --method hang \
  --time-limit 0.2 --out limited

# Means say over how many sequences they are.
cat >two.json <<'JSON'
{ "sequences": [{"path": "street", "name": "a", "frames": "0:0"},
                {"path": "street", "name": "b", "frames": "0:1"}],
  "methods": ["crash"], "threads": 1 }
JSON
expect 1 "(1/2)" run two.json --quiet --out two  # It crashes at its second scan: b has one.

# On a terminal a method's progress is seen, and never taken for its output.
if command -v script >/dev/null; then
  script -qec "\"$raymoval\" run --sequence street --frames 0:9 --method throw --method comb \
    --set comb.milliseconds=100 --threads 1 --out seen" /dev/null >seen.txt </dev/null
  holds "progress is seen" grep -q "combing: [1-9] of 10" seen.txt
  holds "it is no output of the method" grep -q '"output_tail": ""' \
    seen/cells/street/throw-default/cell.json
fi

# Children see data by the options that the run was given.
expect 0 "All controls have their expected scores" run --sequence street --frames 1:5:2 --range 3:40 \
  --name short --method comb --set comb.milliseconds=0.5 --keep-removals --quiet --out options
holds "removals are kept" test -s options/cells/short/comb-default_/removals/000005.label
expect 0 "All controls have their expected scores" run --sequence street --frames 1:5:2 --range 3:40 \
  --name short --method comb --set comb.milliseconds=0.5 --keep-removals --quiet --in-process \
  --out inside
holds "a process of its own changes no result" same_but_times options inside

expect 2 "starts by itself" run-method 3<&- 4<&-
# A shell's own files may be open where the order and the answer are.
expect 2 "starts by itself" run-method 3</dev/null 4</dev/null
expect 2 "starts by itself" run-method 3<two.json 4</dev/null
for wrong in 0 -1 soon; do
  expect 2 "--time-limit" run "${short[@]}" --method comb --time-limit $wrong --out o
  expect 2 "--memory-limit" run "${short[@]}" --method comb --memory-limit $wrong --out o
done
finish isolation
