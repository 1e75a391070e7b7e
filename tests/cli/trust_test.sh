#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Data that is unreadable, incomplete or changing is reported and never scored; files that no run made
# are never deleted. Usage: trust_test.sh PATH/TO/raymoval_faulty
set -uo pipefail
program=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
export RAYMOVAL_CACHE=$work/cache
# A program that waits for a pipe has failed.
cat >"$work/limited" <<SCRIPT
#!/bin/sh
exec timeout 120 "$program" "\$@"
SCRIPT
chmod +x "$work/limited"
raymoval=$work/limited

scene=town:scans=6,sensor=vlp16
expect 0 "" simulate $scene -o whole --quiet
fresh() { rm -rf data && cp -r whole data; }
scores=(run --sequence data --quiet --method comb --protocol erasor --threads 1)

# What cannot be read is never taken for absent, and nothing is waited for.
harmless=0
for file in sequence.json times.txt poses.txt calib.txt labels labels/000002.label \
  velodyne/000003.bin; do
  for harm in "ln -s nowhere" "ln -s $(basename $file)" mkfifo; do
    fresh
    rm -r data/$file
    (cd "data/$(dirname $file)" && $harm "$(basename $file)")
    rm -rf run
    expect 2 "data/$file: " "${scores[@]}" --out run
    [[ -e run/results.json ]] && harmless=$((harmless + 1))
  done
done
holds "none of them is scored" test $harmless -eq 0
for file in sequence.json times.txt; do
  fresh
  rm data/$file && mkdir data/$file
  expect 2 "data/$file: is a folder, expected a file" "${scores[@]}" --out run
done
fresh
rm data/sequence.json data/times.txt
expect 0 "" "${scores[@]}" --out without

# Scans that are replaced by others of equal size between two runs.
fresh
rm -rf run
expect 0 "" "${scores[@]}" --out run
for scan in data/velodyne/*.bin; do printf 'xyz' | dd of=$scan conv=notrunc status=none; done
expect 0 "run   town / comb:default: data fingerprint" "${scores[@]}" --out run --explain
expect 2 "--overwrite" "${scores[@]}" --out run
expect 0 "" "${scores[@]}" --out run --overwrite

# A cache that is shared: two at once, each of them process 1 of its container.
container=(unshare -p -f --mount-proc)
"${container[@]}" true 2>/dev/null || container=(unshare -r -p -f --mount-proc)
if "${container[@]}" true 2>/dev/null; then
  for try in 1 2 3 4 5 6; do
    rm -rf cache
    for who in a b; do
      "${container[@]}" "$raymoval" inspect $scene --frames 0:0 >$who.txt 2>&1 &
      sleep 0.0$((RANDOM % 10))
    done
    wait
    made=$(echo cache/simulated/town-*)
    holds "try $try: one scene and nothing else is in the cache" test -d "$made"
    holds "try $try: it is whole" diff -r --exclude=manifest.json whole "$made"
  done
else
  echo "trust: no process namespaces here; two containers at once were not tried."
fi
# A cleaner of caches takes some scans.
expect 0 "" run --sequence $scene --quiet --method comb --out before
rm cache/simulated/town-*/velodyne/00000[24].bin
expect 0 "); it is simulated again" run --sequence $scene --method comb --out after
holds "the scores are the same" diff <(cut -d, -f1-15 before/results.csv) \
  <(cut -d, -f1-15 after/results.csv)

# Only files of a run are deleted.
mkdir -p mine/thesis.part
echo film >mine/film.mkv.part
expect 2 "Nothing was changed" run --sequence street --frames 0:1 --quiet --method comb --out mine
holds "both are there" test -e mine/film.mkv.part -a -d mine/thesis.part
mv mine/* without/
expect 0 "" "${scores[@]}" --out without
holds "beside a run too" test -e without/film.mkv.part -a -d without/thesis.part

# Several outputs appear together or not at all.
fresh
outputs=(-o out/map.pcd --dynamic out/removed.pcd --labels out/labels --quiet --overwrite --force)
mkdir out
expect 0 "" clean data --method comb "${outputs[@]}"
cp -r out before_fault
export FAULTY_COMMAND="rm out/removed.pcd && mkdir out/removed.pcd && touch out/removed.pcd/mine"
expect 2 "out/removed.pcd: cannot be written (Is a directory). Nothing was changed" \
  clean data --method meddle "${outputs[@]}"
unset FAULTY_COMMAND
holds "what somebody put there is still there" test -e out/removed.pcd/mine
rm -r out/removed.pcd before_fault/removed.pcd
holds "the other outputs are as they were" diff -r before_fault out

# A link to an output stays a link.
mkdir elsewhere
touch elsewhere/map.pcd
ln -s elsewhere/map.pcd link.pcd
expect 2 "is there already" clean data --method comb -o link.pcd --quiet
expect 0 "" clean data --method comb -o link.pcd --quiet --overwrite --force
holds "a link to an output stays a link" test -L link.pcd -a -s elsewhere/map.pcd
ln -s nowhere.pcd lost.pcd
expect 2 "lost.pcd: is a link to nowhere.pcd" clean data --method comb -o lost.pcd --quiet

# Standard output that cannot be written is an error of every command.
for words in --help --version "run --help" "help run" "list methods" "describe raymoval" \
  "table without" "inspect data --quiet" "plan quick" "compare without without"; do
  # shellcheck disable=SC2086
  "$raymoval" $words >/dev/full 2>err.txt
  code=$?
  holds "$words to a full disk is an error" test $code -eq 2
done

# Few descriptors are enough; fewer are reported.
few() { (ulimit -n "$1" && shift && "$raymoval" "$@") >out.txt 2>said.txt; }
few 64 "${scores[@]}" --out few
code=$?
holds "64 descriptors are enough" test $code -eq 0
few 12 "${scores[@]}" --out fewer
code=$?
holds "12 are told" grep -q "Raise the limit of open files (ulimit -n)" said.txt
holds "12 are an error" test $code -eq 2

# A copy that broke off may have any size.
truncate -s 20G data/velodyne/000002.bin
expect 2 "most of which were never written: the copy seems incomplete" \
  "${scores[@]}" --out sparse

# Worlds and sensors are strict JSON.
cat >world.json <<'JSON'
{ "scans": 2, "roads": [{"points": [[-40, 0], [40, 0]]}], "ego": {"points": [[0, 0], [9, 0]]} }
JSON
sed 's/"scans": 2/"scans": 1e309/' world.json >large.json
expect 2 "large.json: holds a number that is too large" simulate large.json -o world
sed 's/"scans": 2/"scans": 2, "scans": 3/' world.json >twice.json
expect 2 'the key "scans" occurs twice in one object' simulate twice.json -o world
echo '{ "kind": "spinning", "noise_m": 1e309 }' >sensor.json
expect 2 "sensor.json: holds a number that is too large" simulate town --sensor sensor.json -o world
finish trust
