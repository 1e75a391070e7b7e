#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Cells that run at once (run --jobs), and times that compare --speed judges.
# Usage: jobs_test.sh PATH/TO/raymoval_faulty
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

cat >suite.json <<'JSON'
{ "sequences": [{"path": "street", "name": "a", "frames": "0:1"},
                {"path": "street", "name": "b", "frames": "3:5"}],
  "methods": ["comb", "comb2", "crash", "raymoval:online"], "protocols": ["erasor", "dynamicmap"],
  "repeats": 2 }
JSON
# The same files except for times, and for the note that times were measured side by side.
expect 1 "b / crash:default: crashed: signal 11" run suite.json --quiet --threads 1 --keep-removals --out one
expect 1 "a / crash:default: crashed: signal 11" run suite.json --quiet --jobs 3 --keep-removals --out three
sed -i '/"jobs": 3/d; s/"threads": 1,$/"threads": 1/' three/run.json three/results.json
sed -i 's/"threads": 1,$/"threads": 1/' one/run.json one/results.json
holds "jobs change no result" same_but_times one three
holds "cells say how they were timed" grep -q '"side_by_side": 3' three/cells/b/comb-default/cell.json
holds "so do repeats" grep -q '"side_by_side": 3' three/cells/b/comb-default/timing-2.json
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

# compare --speed: whole cells, relative to a fixed kernel.
speed() { # FILE WHOLE METHOD: hand-written times
  cat >"$1" <<JSON
{ "schema_version": 1, "scene": "town:scans=30", "scans": 30, "threads": 1, "repetitions": 5,
  "yardstick": {"name": "a yardstick 1", "milliseconds": 100.0},
  "cells": [{"method": "$3",
    "whole": {"milliseconds": 1, "relative": {"median": $2, "min": 1, "max": 20}},
    "load": {"milliseconds": 1, "relative": {"median": 0.1, "min": 1, "max": 2}},
    "run": {"milliseconds": 1, "relative": {"median": 8.0, "min": 1, "max": 2}},
    "score": {"milliseconds": 1, "relative": {"median": 1.9, "min": 1, "max": 2}}}] }
JSON
}
mkdir kernels
speed kernels/speed.json 10.0 raymoval:online
speed same.json 12.9 raymoval:online
speed slow.json 13.1 raymoval:online
speed other.json 10.0 octomap:r20
expect 0 "no regression" compare --speed same.json kernels
expect 1 "the whole cell takes 1.31 times the reference" compare --speed slow.json kernels
expect 0 "no regression" compare --speed slow.json kernels/speed.json --time-band 1.5
expect 2 "folders that scripts/benchmark.sh wrote" compare --speed . kernels
expect 2 "raymoval:online is missing in the run" compare --speed other.json kernels
echo '{' >torn.json
expect 2 "this is not JSON" compare --speed same.json torn.json
expect 2 "it can be combined with --time-band alone" compare --speed same.json kernels --tolerance F1=1
expect 2 "nothing.json: no such file" compare --speed same.json nothing.json
finish jobs
