#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs that are killed, refused, cut into parts or short of disk end with the files of an
# undisturbed run, timings aside.
# Usage: resume_test.sh PATH/TO/raymoval_faulty
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

cat >suite.json <<'JSON'
{ "name": "two",
  "sequences": [{"path": "street", "name": "a", "frames": "0:3"},
                {"path": "street", "name": "b", "frames": "4:6"}],
  "methods": ["comb", {"method": "comb2", "set": {"milliseconds": 5}}],
  "protocols": ["erasor"],
  "threads": 1 }
JSON
run=(run suite.json --quiet --keep-removals)
expect 0 "All controls have their expected scores" "${run[@]}" --out whole

# A folder that is moved away ends the run, which makes no second one in its place.
"$raymoval" "${run[@]}" --set comb.milliseconds=300 --out moving >out.txt 2>err.txt &
process=$!
wait_for moving/cells/a $process
mv moving moved
wait $process
code=$?
cp err.txt said.txt
holds "a run whose folder is moved ends with 2, not $code" test $code -eq 2
holds "and says so" grep -q "moving: is no longer the folder of this run" said.txt
holds "and makes no other folder" test ! -e moving
expect 0 "All controls have their expected scores" "${run[@]}" --set comb.milliseconds=300 --out moved

# Killed at any moment, started again and again.
RANDOM=5
kills=0
finished=no
for _ in $(seq 60); do
  "$raymoval" "${run[@]}" --out killed >out.txt 2>err.txt &
  process=$!
  sleep "0.$(printf '%03d' $((RANDOM % 300 + 10 * kills)))"
  kill -KILL $process 2>/dev/null && kills=$((kills + 1))
  wait $process 2>/dev/null && { finished=yes; break; }
done
holds "it was killed several times ($kills)" test $kills -ge 3
[[ $finished == yes ]] || expect 0 "" "${run[@]}" --out killed
holds "a killed run ends with the files of an undisturbed one" same_but_times whole killed
holds "no child of a killed run is left" test -z "$(left_over)"
before=$(find killed -name '*.json' -path '*cells*' -exec stat -c '%n %y' {} + | sort)
expect 0 "" "${run[@]}" --out killed
holds "what is whole is not run again" test "$before" = \
  "$(find killed -name '*.json' -path '*cells*' -exec stat -c '%n %y' {} + | sort)"

# What changes makes exactly the affected cells stale, and is named.
# stale COUNT REASON...: how many cells are to be run, and why.
stale() {
  expect 0 "$1 of 10 cells are to be run" run changed.json --quiet --keep-removals --explain \
    --out whole
  local explained
  explained=$(cat out.txt)
  holds "$1 cells are listed" test "$(grep -c '^run ' <<<"$explained")" -eq "$1"
  for reason in "${@:2}"; do
    holds "it says '$reason'" grep -qF -- "$reason" <<<"$explained"
  done
}
cp suite.json changed.json
stale 0
sed 's/"milliseconds": 5/"milliseconds": 6/' suite.json >changed.json
stale 2 "run   a / comb2:default*: parameter milliseconds was 5.0, is 6.0" "keep  a / comb:default"
sed 's/"4:6"/"4:5"/' suite.json >changed.json
stale 5 "run   b / oracle:default: data frames" "keep  a / oracle:default"
sed 's/"erasor"/{"protocol": "erasor", "set": {"voxel_size": 0.3}}/' suite.json >changed.json
stale 10 "protocol erasor options voxel_size was 0.2, is 0.3"
sed 's/"erasor"/"erasor", {"protocol": "erasor", "as": "again"}/' suite.json >changed.json
stale 10 "protocol again is new"
cp suite.json changed.json
export FAULTY_VERSION=2
stale 4 'run   b / comb:default: method version was "1", is "2"' "keep  b / noop:default"
unset FAULTY_VERSION
cp -r whole hurt
cell=cells/a/comb-default/cell.json
sed -i 's/"removed": 4/"removed": 5/; s/"ok"/"OK"/' hurt/$cell
expect 0 "run   a / comb:default: cell.json is damaged" "${run[@]}" --explain --out hurt
head -c 700 whole/$cell >hurt/$cell
head -c 700 whole/results.json >hurt/results.json
expect 0 "1 of 10 cells are to be run" "${run[@]}" --explain --out hurt
expect 2 "not a whole result file" table hurt
truncate -s -4 hurt/cells/b/comb2-default_/removals/000005.label
expect 0 "run   b / comb2:default*: its removals" "${run[@]}" --explain --out hurt
expect 0 "" "${run[@]}" --out hurt
holds "a run mends what was hurt" same_but_times whole hurt
expect 0 "10 of 10 cells are to be run" "${run[@]}" --explain --out nowhere
holds "an explanation makes no folder" test ! -e nowhere

# Parts of a run, and what is made of them.
only=(a 'b/comb*' 'b/[nor]*')
for i in 1 2 3; do expect 0 "" "${run[@]}" --only "${only[i - 1]}" --out part$i; done
holds "parts do not overlap" test "$(cat part?/results.csv | grep -c ,erasor,)" -eq 10
expect 0 "not run" table part2
mkdir merged
for i in 1 2 3; do cp -r part$i/cells merged/; done
expect 0 "" "${run[@]}" --collect --out merged
holds "copied together they are a whole run" same_but_times whole merged
rm -r merged/cells/b/noop-default
expect 1 "cells are missing: b / noop:default" "${run[@]}" --collect --out merged
holds "collecting runs nothing" test ! -e merged/cells/b/noop-default
expect 0 "" "${run[@]}" --only 'b/*' --only 'noop:*' --out merged
holds "then it is whole again" same_but_times whole merged
expect 0 "not run" "${run[@]}" --only 'a/comb*' --out some
holds "only what was asked for is run" test "$(find some -name cell.json | wc -l)" -eq 2
expect 2 "Did you mean 'a/noop:default'" "${run[@]}" --only a/nop:default --out some
expect 2 "leave out" "${run[@]}" --collect --only a --out o
expect 2 "--cell cannot be combined with" "${run[@]}" --cell a/noop:default --explain --out o

# Cell by cell, several at a time, as a scheduler does it.
expect 0 '"cell":"a/noop:default"' plan suite.json --quiet
"$raymoval" plan suite.json --quiet >plan.jsonl
holds "a line for each cell" test "$(wc -l <plan.jsonl)" -eq 10
sed -E 's/.*"key":"([0-9a-f]{32})".*/\1/' plan.jsonl |
  xargs -P 3 -I KEY "$raymoval" "${run[@]}" --out single --cell KEY >out.txt 2>err.txt
holds "every key was found" test "$(find single -name cell.json | wc -l)" -eq 10
expect 0 "" "${run[@]}" --collect --out single
holds "cells that were run alone are those of a whole run" same_but_times whole single
expect 0 '"to_run":false,"why":""' plan suite.json --quiet --out single
sed 's/"erasor"/{"protocol": "erasor", "set": {"voxel_size": 0.3}}/' suite.json >changed.json
expect 0 '"cell":"a/noop:default"' plan changed.json --quiet
expect 2 "would refuse this folder: --out single: " plan changed.json --quiet --out single
cp out.txt planned.txt
holds "nothing is planned for a folder that a run refuses" test ! -s planned.txt
expect 2 "has no such cell" "${run[@]}" --out single --cell 0123456789abcdef0123456789abcdef
expect 2 "Did you mean 'a/comb:default'" "${run[@]}" --out single --cell a/comb:defalt

# Two at once: the second is refused, and what a dead one left is taken over.
slow=(run --sequence street --frames 0:3 --quiet --method hang --out busy)
"$raymoval" "${slow[@]}" >busy.txt 2>&1 &
process=$!
wait_for busy/cells/street/oracle-default/cell.json $process
expect 2 "another run is writing there (process $process on $(uname -n))" "${slow[@]}"
expect 2 "another run is writing there" "${slow[@]}" --cell street/noop:default
expect 0 "keep  street / noop:default" "${slow[@]}" --explain
kill -KILL $process
wait $process 2>/dev/null
holds "the dead one left its lock" test -s busy/run.lock
expect 0 "" "${slow[@]}" --only noop:default
holds "no lock is left" test ! -e busy/run.lock
"$raymoval" "${slow[@]}" --cell street/hang:default >busy.txt 2>&1 &
process=$!
wait_for busy/cells/street/hang-default/run.lock $process
expect 2 "another run is writing there" "${slow[@]}" --cell street/hang:default
expect 0 "" "${slow[@]}" --cell street/noop:default
expect 2 "another run is writing there" "${slow[@]}" --only noop:default
kill -INT $process
wait $process
holds "an interrupted cell exits with 130" test $? -eq 130
holds "its hanging child is gone" test -z "$(left_over)"
holds "no lock is left by it" test -z "$(find busy -name run.lock)"

# No room, or no right to write: a clear error, and what was there stays.
(
  ulimit -f 24  # A cell fits, results.json does not.
  "$raymoval" run --sequence street --frames 0:0 --quiet --in-process --method comb --out small \
    >small.txt 2>&1
  echo $? >>small.txt
)
holds "a file that may not grow is told" grep -q "results.json: cannot be written (File too large" \
  small.txt
holds "with exit code 2" test "$(tail -1 small.txt)" = 2
expect 0 "" run --sequence street --frames 0:0 --quiet --method comb --out small
if mkdir disk && mount -t tmpfs -o size=400k none disk 2>/dev/null; then
  trap 'umount "$work/disk"; rm -rf "$work"' EXIT
  one=(run --sequence street --frames 0:0 --quiet --method comb --threads 1)
  expect 0 "" "${one[@]}" --out roomy
  dd if=/dev/zero of=disk/filler bs=4k count=96 2>/dev/null
  expect 2 "No space left on device" "${one[@]}" --out disk/run
  holds "nothing half written is left" test -z "$(find disk -name '*.part')"
  rm disk/filler
  expect 0 "" "${one[@]}" --out disk/run
  holds "with room it ends as any other" same_but_times roomy disk/run
  cp -r disk/run copy
  dd if=/dev/zero of=disk/filler bs=4k 2>/dev/null
  expect 2 "No space left on device" "${one[@]}" --set comb.milliseconds=1 --out disk/run
  holds "the results that were there are still whole" cmp copy/results.json disk/run/results.json
  expect 0 "comb:default" table disk/run
  mount -o remount,ro disk
  expect 2 "Read-only file system" "${one[@]}" --out disk/run
  expect 2 "Read-only file system" "${one[@]}" --out disk/other
  expect 0 "comb:default" table disk/run
  expect 0 "0 of 4 cells" "${one[@]}" --explain --out disk/run
else
  echo "resume: no small disk can be mounted here; only the file limit was tried."
fi
finish resume
