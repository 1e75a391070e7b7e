#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Cells that run at once (run --jobs).
# Usage: jobs_test.sh PATH/TO/raymoval_faulty
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

cat >suite.json <<'JSON'
{ "sequences": [{"path": "street", "name": "a", "frames": "0:1"},
                {"path": "street", "name": "b", "frames": "3:5"}],
  "methods": ["comb", "comb2", "crash", "raymoval:online"], "protocols": ["erasor", "dynamicmap"] }
JSON
# The same files except for times, and for the note that times were measured side by side.
expect 1 "b / crash:default: crashed: signal 11" run suite.json --quiet --threads 1 --keep-removals --out one
expect 1 "a / crash:default: crashed: signal 11" run suite.json --quiet --jobs 3 --keep-removals --out three
sed -i '/"jobs": 3/d; s/"threads": 1,$/"threads": 1/' three/run.json three/results.json
sed -i 's/"threads": 1,$/"threads": 1/' one/run.json one/results.json
holds "jobs change no result" same_but_times one three
holds "cells say how they were timed" grep -q '"side_by_side": 3' three/cells/b/comb-default/cell.json
holds "alone they say nothing" test "$(grep -rl side_by_side one | wc -l)" -eq 0
holds "tables say it" grep -q "Up to 3 cells ran in parallel" three/table.md
holds "nothing that was started is left" test -z "$(left_over)"
holds "no lock is left" test ! -e three/run.lock

# Two really are at work at once: each waits for the file that the other makes.
cat >both.json <<'JSON'
{ "sequences": [{"path": "street", "name": "a", "frames": "0:1"},
                {"path": "street", "name": "b", "frames": "0:1"}],
  "methods": ["meddle"], "controls": false }
JSON
touch_and_wait='touch here.$$; for i in $(seq 600); do [ $(ls here.* | wc -l) -ge 2 ] && exit 0; sleep 0.1; done; exit 1'
FAULTY_COMMAND=$touch_and_wait expect 0 "" run both.json --quiet --jobs 2 --out both

# Limits hold for each cell, and the other cells run.
expect 1 "hang:default: did not finish within 4 s" run --sequence street --frames 0:2 --quiet --jobs 2 \
  --method hang --method stray --method comb --time-limit 4 --out limits
holds "both were ended" test "$(grep -c ',timeout,' limits/results.csv)" -eq 2
holds "the good one has a score" grep -q "^street,comb,default,erasor,ok,[0-9]" limits/results.csv

# On a signal it ends all cells, and the same command resumes.
slow=(--sequence street --frames 0:3 --method comb --method comb2 --set comb.milliseconds=600
  --set comb2.milliseconds=600)
"$raymoval" run "${slow[@]}" --quiet --jobs 2 --out cut >out.txt 2>err.txt &
process=$!
until [[ $(pgrep -P $process | wc -l) -ge 2 ]] || ! kill -0 $process 2>/dev/null; do sleep 0.02; done
holds "two children at once" test "$(pgrep -P $process | wc -l)" -ge 2
kill -TERM $process
wait $process
holds "it ends with the signal's code" test $? -eq 143
holds "no child is left" test -z "$(left_over)"
holds "the controls are kept" test -s cut/cells/street/noop-default/cell.json
expect 0 "All controls have their expected scores" run "${slow[@]}" --quiet --jobs 2 --out cut
holds "it is whole" test "$(grep -c ',ok,' cut/results.csv)" -eq 5

# What does not go together.
short=(--sequence street --frames 0:0 --method comb)
for wrong in 0 -1 two 9999; do
  expect 2 "--jobs $wrong: expected a whole number" run "${short[@]}" --jobs=$wrong --out o
done
expect 2 "one thread, but 2 threads are asked for" run "${short[@]}" --jobs 2 --threads 2 --out o
expect 2 "leave --in-process out" run "${short[@]}" --jobs 2 --in-process --out o
expect 2 "leave --jobs out" run "${short[@]}" --jobs 2 --cell street/comb:default --out o
holds "nothing was made" test ! -e o
expect 0 "All controls" run "${short[@]}" --jobs 1 --threads 2 --quiet --out o

# Times of one run at once and of one alone are not judged against each other.
expect 0 "All controls" run "${short[@]}" --threads 1 --quiet --out alone
expect 0 "All controls" run "${short[@]}" --jobs 2 --quiet --out beside
expect 0 "not compared: times were not taken alike" compare beside alone
expect 2 "times were not taken alike" compare beside alone --time-band 1000
expect 0 "no regression" compare beside beside --time-band 1000

finish jobs
