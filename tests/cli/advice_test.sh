#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The advice of the program for a folder, a suite, a run or an output that is not the expected one.
# Usage: advice_test.sh PATH/TO/raymoval 1|0
# 1 if it has PCL.
set -uo pipefail
raymoval=$(readlink -f "$1")
has_pcl=$2
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
export RAYMOVAL_CACHE=$work/cache
short=(--sequence street --frames 0:2 --quiet)

expect 0 "2 scans" simulate town -o data/05 --scans 2 --sensor vlp16 --seed 3 --quiet
expect 0 ": 1 scan, " simulate town -o one --scans 1 --sensor vlp16 --quiet
mkdir -p unlabelled/sequences empty
cp -r data/05 unlabelled/sequences/05
rm -r unlabelled/sequences/05/labels
expect 0 "" run --sequence data/05 --name town --method noop --quiet --keep-removals --out kept

# If a name is a scene and a folder, the user must choose.
cp -r data/05 town
mkdir street
both="town: is a scene and also a folder here; write ./town for the folder, or town:seed=1 for the scene."
expect 2 "$both" run --sequence town --method noop --out o
expect 2 "$both" clean town -o map.pcd
expect 2 "$both" score --sequence town --predictions empty
expect 2 "$both" inspect town
expect 2 "write ./street for the folder" run "${short[@]}" --method noop --out o
rmdir street
expect 0 "2 of 2 scans read" inspect ./town --quiet
expect 0 "of 2 scans read" inspect town:scans=2,sensor=vlp16 --quiet
mkdir -p suites/town
echo '{"sequences": ["town"], "methods": ["noop"]}' >suites/both.json
expect 2 "suites/both.json: sequences[0]: $both" run suites/both.json --out o
expect 0 "" picture kept -o map.png --overwrite --only '*' --quiet --data town
rm -r town suites/town
expect 2 "--data town: no such folder" picture kept -o map.png --overwrite --only '*' --quiet --data town

# A page with points is not replaced by one without them where --data leads elsewhere.
expect 0 "wrote" report kept -o page.html --quiet --data data/05
cp page.html before.html
expect 2 "no such folder" report kept -o page.html --overwrite --quiet --data nowhere
expect 2 "it holds 1 scan, and the run had 2" report kept -o page.html --overwrite --quiet --data one
expect 2 "no known layout" report kept -o page.html --overwrite --quiet --data empty
holds "the page is as it was" cmp page.html before.html
expect 2 "--data data/05: is for the 3-D view, which --no-points leaves out" \
  report kept --no-points --data data/05

# Folders and scenes where a suite is expected, and words too many.
for place in data/05 town unlabelled:05; do
  for command in run plan; do
    expect 2 "name a method with --method NAME[:variant], or all of them with --method all" \
      $command $place
  done
done
expect 0 "All controls have their expected scores" run data/05 --method noop --quiet --out by_place
expect 2 "has no labels" run unlabelled:05 --method noop --out o
mkdir -p intensity/pcd
printf '%s\n' "VERSION 0.7" "FIELDS x y z intensity" "SIZE 4 4 4 4" "TYPE F F F F" "COUNT 1 1 1 1" \
  "WIDTH 1" "HEIGHT 1" "VIEWPOINT 0 0 0 1 0 0 0" "POINTS 1" "DATA ascii" "5 0 0 1" \
  >intensity/pcd/000000.pcd
expect 2 "expected --label-rule FILE, because labels are the intensity of the points in this layout" \
  run intensity --method noop --out o
expect 2 "expected a folder labels/ beside the scans" run unlabelled:05 --method noop --out o
expect 2 "nowhere: no such folder" run nowhere --method noop --out o
expect 2 "nowhere: no such suite file" run nowhere --out o
expect 2 "Name it with --sequence one." run data/05 one --method noop --out o
mkdir quick
expect 2 "If the folder of that name is meant, write ./quick." run quick --method noop --out o
rmdir quick
expect 2 "--predictions DIR is missing" score data/05
for command in "clean -o map.pcd --method noop" inspect; do
  # shellcheck disable=SC2086
  expect 0 "" $command --sequence data/05 --quiet
  # shellcheck disable=SC2086
  expect 2 "--sequence is given 2 times" $command data/05 --sequence data/05
done
rm map.pcd
expect 2 "SUITE is missing" run
expect 2 "SUITE is missing" run --method noop
expect 2 "a method with --method" plan --sequence data/05

# Folders that are no runs; references have no run.json.
for command in table report "compare kept" "picture -o p.png"; do
  # shellcheck disable=SC2086
  expect 2 "data/05: is not a run folder (no run.json in it)" $command data/05
done
mkdir reference early early/cells
cp kept/results.json reference
expect 0 "noop" table reference
expect 2 "did not reach its end" table early

# Roots of SemanticKITTI that are none, or incomplete.
for suite in kth semantickitti; do
  expect 2 "empty: holds no folder sequences/; expected the root of SemanticKITTI" \
    run "$(suite_anywhere $suite)" --data empty --out o
done
expect 2 "and sequences/ holds 05." inspect unlabelled:kitti-00
expect 2 "unlabelled/sequences/05: segment kitti-05 is frames 2350:2670:2, but the data has 2 frames from 0 to 1. Copy the missing ones, or name your own part: --sequence unlabelled:05 --frames 0:1." \
  clean unlabelled:kitti-05 -o map.pcd
expect 2 "has no sequence '06'. Did you mean '05'? A root holds sequences/NN; known here: 05, kitti" \
  inspect unlabelled:06
expect 2 "sequence 'town' has no labels, and oracle needs them; choose another --method." \
  clean unlabelled:05 -o map.pcd --method oracle --quiet

# A file that cannot be written is reported before the work.
there="there is no folder nowhere. Make it first."
expect 2 "nowhere/a.json: $there" score --sequence data/05 --predictions empty --json nowhere/a.json
expect 2 "nowhere/a.png: $there" picture kept -o nowhere/a.png
expect 2 "nowhere/a.html: $there" report kept -o nowhere/a.html

# Slips of words, values and options without one.
expect 2 "Did you mean 'town'" simulate twon -o o
expect 2 "A single frame is 5:5." inspect data/05 --frames 5
expect 2 "matches no cell of this run" picture kept -o map.png --overwrite --only nothing --quiet
expect 2 "matches no cell of this suite" run "$(suite_anywhere simulated)" --only nothing --out o
holds "nothing was generated to find out" test -z "$(find cache -name 'highway*')"
expect 2 "are called 'town' (data/05 and one). Run them into two folders, the second with --name NAME" \
  run --sequence data/05 --sequence one --method noop --out o
expect 2 "--output: FILE is missing after it. See \`raymoval clean --help\`." clean data/05 --output
expect 2 "--frames: FIRST:LAST:STRIDE is missing after it. See \`raymoval run --help\`." run --frames

# Letters of the other case, values in the other order, units, several methods at once.
expect 2 "Did you mean 'erasor'" run "${short[@]}" --method ERASOR --out o
expect 2 "Did you mean 'hdl64e'" run "${short[@]}" --method noop --sensor HDL64E --out o
expect 2 "MIN comes first: write 2:50." run "${short[@]}" --method noop --range 50:2 --out o
expect 2 "Write :50 for at most 50 m" run "${short[@]}" --method noop --range 50 --out o
echo '{"sequences": [{"path": "street", "range_m": {"min": 50, "max": 2}}], "methods": ["noop"]}' \
  >swapped.json
expect 2 "min is 50 and max 2" run swapped.json --out o
expect 2 "500MB, 2GB or 2GiB" run "${short[@]}" --method noop --memory-limit 2XB --out o
expect 2 "90s, 5min or 2h" run "${short[@]}" --method noop --time-limit 5:00 --out o
expect 0 "All controls" run "${short[@]}" --method noop --memory-limit 2GB --time-limit 5min \
  --out limits
expect 0 "run   street / dufomap:offline" run "${short[@]}" --method all --method raymoval:online \
  --explain --out o
# Without PCL, no method that needs it runs, in any form of request.
echo '{"sequences": ["street"], "methods": ["noop", "octomap", "octomap:ground"]}' >ground.json
if [[ $has_pcl == 1 ]]; then
  expect 0 "run   street / octomap:ground-noise" run "${short[@]}" --method octomap:all \
    --method octomap --explain --out o
  expect 0 "ground plane ('w G')." describe octomap
  holds "nothing is said of PCL" test -z "$(grep 'PCL, which this build lacks' out.txt)"
else
  for asked in "run ground.json" "run --sequence street --method octomap:all" "plan ground.json" \
    "run --sequence street --method noop --method octomap --set octomap.ground=true" \
    "clean street -o map.pcd --method octomap:ground-noise"; do
    read -ra words <<<"$asked"
    [[ $asked == clean* || $asked == plan* ]] || words+=(--out needs_pcl)
    expect 2 "need PCL, and this program was built without it. Install libpcl-dev" "${words[@]}"
    holds "$asked: nothing was run or written" test ! -e needs_pcl -a ! -e map.pcd -a -z "$(cat out.txt)"
  done
  expect 0 "ground plane ('w G'). It needs PCL, which this build lacks." describe octomap
  expect 0 "filter ('w GF'). It needs PCL, which this build lacks." list variants
fi
count=$("$raymoval" list methods | grep -cvE '^(noop|remove-all|oracle|external:MANIFEST) ')
expect 2 "'all' stands for $count methods, and one is expected here" clean street -o map.pcd --method all
expect 2 "--frames is given 2 times" run "${short[@]}" --frames 0:1 --method noop --out o
expect 2 "Did you mean '--out'" run "${short[@]}" --method noop -o o
expect 2 "Did you mean '--version'" version
expect 2 "without a unit" clean street -o map.pcd --voxel 10cm
expect 2 "a name that ends in .html" report kept -o page.pdf
expect 2 "expected a run folder" table kept/results.csv
expect 2 "'raymoval.tau0' is a parameter; \`raymoval describe raymoval\`" describe raymoval.tau0

# Scene and sensor files go by their paths.
mkdir files
echo '{"roads": []}' >files/w.json
expect 2 "files/w.json: key 'ego' is missing; it has no default." simulate files/w.json -o o
echo '{"kind": "spinning"}' >files/s.json
expect 2 "files/s.json: 'banks' is nothing" simulate town -o o --sensor files/s.json --scans 1
echo '{' >files/w.json
expect 2 "files/w.json: line 2" simulate files/w.json -o o

# Names of values are those of the field, not of the parser.
for command in run plan score clean simulate inspect report picture table compare; do
  "$raymoval" $command --help >help.txt
  holds "$command --help names its values" test -z "$(grep -E '^ .*\b(TEXT|INT|FLOAT)\b' help.txt)"
done
expect 0 "default: raymoval_plus:offline" clean --help
expect 0 "times are shown and not compared" compare --help
expect 0 "About thirty" inspect --help
for command in "" compare; do
  # shellcheck disable=SC2086
  expect 0 "raymoval compare out/quick results/reference/street" $command --help
done
expect 0 "the default variant of every method" list suites
expect 0 "this project" describe raymoval_plus
parameters() { "$raymoval" describe "$@" | sed -nE 's/^  ([a-z_0-9]+) = .*/\1/p'; }
holds "describe shows five main parameters" test "$(parameters raymoval_plus | wc -l)" -eq 5
holds "with --all they come first" test "$(parameters raymoval_plus --all | head -n 5)" = "$(parameters raymoval_plus)"
holds "and each comes once" test -z "$(parameters raymoval_plus:online --all | sort | uniq -d)"
holds "and all are there" test "$(parameters raymoval_plus --all | wc -l)" -eq \
  "$("$raymoval" describe raymoval_plus --markdown | grep '^| [a-z_0-9]* *|' | grep -vc '^| name ')"
expect 0 "If too much is removed" describe raymoval_plus
expect 0 "raymoval_plus:offline removed" clean street --frames 0:2 --quiet -o best.pcd
holds "no refused command left anything" test ! -e o -a ! -e map.pcd

finish advice
