#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Drives the program as its users do: command x data x configuration, bad input, exit codes.
# Usage: cli_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

short=(--sequence street --frames 0:2 --quiet)

# Help and listings.
expect 0 "Examples" --help
for command in run plan table compare list describe score clean simulate inspect report picture; do expect 0 "Examples" "$command" --help; done
expect 0 "Scenes that are not in the cache are simulated first" run --help
expect 0 "into \$RAYMOVAL_CACHE" plan --help
expect 0 "raymoval 1." --version
expect 0 "oracle" list
for what in methods variants protocols columns sensors sequences scenes simulated-sensors \
  suites; do expect 0 "" list "$what"; done
expect 0 "FILE.db3 " list sequences
expect 0 "a folder of .pcd, .ply, .bin, .las, .npy or .npz scans with poses.txt" list sequences
for name in raymoval raymoval:online noop erasor dynamicmap protocol:erasor; do
  for form in "" --markdown; do expect 0 "" describe "$name" ${form:+"$form"}; done
done
expect 0 "tau0" describe raymoval:offline --markdown
holds "words in a table of parameters begin on the left" test -z "$(grep -e '-: |' out.txt)"
expect 0 "raymoval describe protocol:erasor" describe erasor
expect 0 "PR, RR, F1" describe protocol:erasor
expect 2 "there is no method or protocol" describe protocol:erasr

# Confidence. Cells without it are run again, unless their method has none.
expect 0 "Confidence: How likely" describe octomap
expect 0 "Confidence: none." describe raymoval
asked=(run "${short[@]}" --method octomap --method raymoval:online --out sure)
expect 0 "" "${asked[@]}"
expect 0 "1 of 5 cells are to be run." "${asked[@]}" --confidence --explain
expect 0 "octomap:r20: its confidence is requested" "${asked[@]}" --confidence --explain
expect 0 "" "${asked[@]}" --confidence
expect 0 "0 of 5 cells are to be run." "${asked[@]}" --confidence --explain
holds "the cell has bins" grep -q '"mean_gap"' sure/cells/street/octomap-r20/cell.json
holds "others have none" test -z "$(grep -l mean_gap sure/cells/street/raymoval-online/cell.json)"
holds "the table tells" grep -q "Confidence of octomap" sure/table.md
expect 0 "" report sure -o sure.html --no-points
holds "the page has the chart" grep -q "Confidence of points, and the share of them that moves" sure.html

# Slips of the command line name what is near.
expect 2 "a command is missing"
expect 2 "'run'" runn
expect 2 "'--frames'" run --fames 0:2
expect 2 "'--version'" --versoin
expect 2 "was not expected" list methods more
expect 2 "Did you mean 'methods'" list method
expect 2 "Did you mean 'erasor'" describe erasr
expect 2 "no variant 'onlin'" describe raymoval:onlin
expect 2 "--out" run "${short[@]}" --method noop
expect 2 "--method" run "${short[@]}" --out o
expect 2 "--sequence" run --method noop --out o
expect 2 "Did you mean 'raymoval'" run "${short[@]}" --method raymovl --out o
expect 2 "external: names no manifest. Expected external:PATH" \
  run "${short[@]}" --method external: --out o
expect 2 "two methods" run "${short[@]}" --method noop --method noop:default --out o
expect 2 "METHOD.key=value" run "${short[@]}" --method raymoval --set tau0=1 --out o
expect 2 "write protocol:erasor.key=value" run "${short[@]}" --method noop --set erasor.lift=0 --out o
expect 2 "'lift'" run "${short[@]}" --method noop --set protocol:erasor.lft=0 --out o
expect 2 "not a requested protocol" run "${short[@]}" --method noop --set protocol:dynamicmap.distance=1 --out o
expect 2 "'tau0'" run "${short[@]}" --method raymoval --set raymoval.tau=1 --out o
expect 2 "out of range" run "${short[@]}" --method raymoval --set raymoval.tau0=-1 --out o
expect 2 "not in this run" run "${short[@]}" --method raymoval --set noop.tau0=1 --out o
expect 2 "Did you mean 'erasor'" run "${short[@]}" --method noop --protocol erasr --out o
expect 2 "--threads" run "${short[@]}" --method noop --threads 0 --out o
expect 2 "--threads" run "${short[@]}" --method noop --threads two --out o
expect 2 "--range" run "${short[@]}" --method noop --range 5 --out o
expect 2 "--range" run "${short[@]}" --method noop --range 9:5 --out o
expect 2 "" run --sequence street --frames nine --method noop --out o
expect 2 "" run --sequence street --sensor nose --method noop --out o
expect 2 "'nowhere' was not expected here" run street nowhere --method noop --out o
expect 2 "--method cannot be given together with the suite" run simulated --method noop --out o
expect 2 "expected METHOD.key=value" run "${short[@]}" --method raymoval --set raymoval.tau0 0.2 --out o
expect 2 "once for each" run "${short[@]}" --method raymoval:online,raymoval:offline --out o
expect 2 "ROOT:kitti-05" run --sequence kitti-05 --method noop --out o
expect 2 "nowhere" run --sequence nowhere --method noop --out o
expect 2 "nowhere" run nowhere.json --out o
expect 2 "nothing to run on" plan
expect 2 "Did you mean 'simulated'" plan simulatd
expect 2 "no such run folder" table nowhere
expect 2 "RUN is missing" table
expect 2 "RUN is missing" report
expect 2 "no such run folder" report nowhere
expect 2 "--points 7" report nowhere --points 7
holds "no bad command line made a folder" test ! -e o

# A run, its files, and what reads them.
expect 0 "All controls have their expected scores" run "${short[@]}" --method raymoval:online \
  --set raymoval.tau0=0.2 --keep-removals --out run
for file in run.json results.json results.csv table.md table.tex; do
  holds "the run has $file" test -s run/$file
done
cell=run/cells/street/raymoval-online_
holds "the cell is there" test -s $cell/cell.json
holds "the setting is recorded" grep -q '"tau0": 0.2' $cell/cell.json
holds "the build says its commit" grep -qE '"commit": "([0-9a-f]{40}|unknown)"' run/run.json
holds "and whether its tree was clean" grep -qE '"source_tree": "(clean|changed|unknown)"' run/run.json
holds "removals are kept" test -s $cell/removals/000002.label
holds "no part file is left" test -z "$(find run -name '*.part')"
holds "no path is told" test -z "$(grep -rlF "$work" run)"
cp $cell/cell.json before.json
expect 0 "" run "${short[@]}" --method raymoval:online --set raymoval.tau0=0.2 --keep-removals \
  --out run
holds "a cell that is there is not run again" cmp before.json $cell/cell.json
for format in md csv tex json; do expect 0 "raymoval" table run --format $format; done
"$raymoval" table run --format csv >again.csv
holds "the table prints what the run wrote" cmp again.csv run/results.csv
expect 2 "street: no paper has numbers for it by erasor" table run --with-published
holds "nothing of papers stands beside other sequences" test ! -s out.txt
expect 2 "'md'" table run --format mdx
expect 2 "--with-published" table run --format csv --with-published
expect 0 "| raymoval:online\\* " table run --rates F1,PR --decimals 1 --sort F1
cp out.txt told.txt
holds "the rates are in the order asked for" grep -qE '^\| method +\| +F1 \| +PR \|$' told.txt
expect 0 "| raymoval:online" table run --only 'street/raymoval*'
cp out.txt told.txt
holds "what was not chosen is left out" test -z "$(grep noop told.txt)"
expect 0 "| sequence " table run --layout paper
expect 2 "'paper'" table run --layout papper
expect 2 "--sort need" table run --format json --sort F1
expect 2 "matches no cell of this run" table run --only nothing

# A changed parameter is marked in every table, and may have a name.
note="tau0 = 0.2 (default 0.3)"
expect 0 "raymoval:online\\*: $note" table run
expect 0 "raymoval:online*: $note" table run --format tex
expect 0 ",raymoval:online*" table run --format csv
expect 0 "" picture run -o changed.svg --kind accuracy-time
holds "a chart has the note" grep -qF "raymoval:online*: $note</text>" changed.svg
expect 0 "named: $note" run "${short[@]}" --method raymoval:online --set raymoval.tau0=0.2 --as named --out named
holds "a name of --as is that of the cell" test -s named/cells/street/named/cell.json
expect 0 "raymoval:online*: $note" run "${short[@]}" --method raymoval:online --set raymoval.tau0=0.2 --out named
expect 0 "raymoval:online " run "${short[@]}" --method raymoval:online --out named
holds "all stand beside the default" test "$(grep -cE ',(named|raymoval:online\*?)$' named/results.csv)" -eq 3
expect 2 "--as x: names one method" run "${short[@]}" --method noop --method raymoval --as x --out o
expect 2 "--as cannot be given together with the suite" run quick --as x --out o
holds "options stand in groups" grep -qx "Method options:" <("$raymoval" help run)

# By default, LaTeX has the accuracy only.
"$raymoval" table run --format tex >run.tex
holds "one table" test "$(grep -c 'begin{table' run.tex)" -eq 1
holds "its caption names the frames" grep -qF 'On street (frames 0 to 2, stride 1, 3 scans, any range).' run.tex
holds "it has a label" grep -qF '\label{tab:accuracy-by-protocol-erasor}' run.tex
expect 0 "Time of raymoval:online*" table run --format tex --what times,stages
expect 2 "'stages'" table run --what stage
expect 2 "has no such table" table run --what confidence
"$raymoval" table named --format csv --sort ms >sorted.csv
holds "a CSV is sorted, too" sort -c -t, -g -k16,16 <(grep -E 'named|online' sorted.csv)

# Papers' rows are beside the same frames only, for any name of the sequence.
make_drive ten/05 0 9 1
make_drive segment/05 2350 2670 2
for drive in ten segment; do expect 0 "" run $drive/05 --method raymoval:online --quiet --out $drive.run; done
expect 2 "05: the papers have frames 2350:2670:2 (161 scans), and this run has 0:9:1 (10 scans)" \
  table ten.run --with-published
expect 0 "| ERASOR (published) " table segment.run --with-published
for drive in ten segment; do expect 0 "" report $drive.run --quiet --no-points -o $drive.html; done
holds "nor in a report" test -z "$(grep -l '(published)' ten.html)"
holds "a report has those of the same frames" grep -q '(published)' segment.html
holds "a report has BibTeX to copy" grep -q 'lim2021erasor' ten.html

# Options of a protocol from the command line; frame = erasor needs a camera's calibration.
expect 0 "All controls have their expected scores" run "${short[@]}" --method noop --protocol dynamicmap \
  --set protocol:dynamicmap.maximum_range=10 --out near
holds "a protocol's option is recorded" grep -q '"maximum_range": 10' \
  near/cells/street/noop-default/cell.json
expect 2 "has those of the LiDAR" run "${short[@]}" --method noop \
  --set protocol:erasor.frame=erasor --out frame
expect 2 "Did you mean 'erasor'" run "${short[@]}" --method noop --set protocol:erasor.frame=eraser --out o

# A reference has no times and no machine; a run is compared with it by counts.
expect 0 "without times: --time-band cannot be used with it" compare run reference --update
holds "a reference has no times" test -z "$(grep -F seconds reference/results.json)"
expect 0 "no regression" compare run reference
expect 0 "no regression" compare run/results.json reference/results.json --tolerance F1=0.002
expect 0 "1.00 times" compare run run --time-band 3
expect 2 "--time-band" compare run reference --time-band 3
holds "a reference without times is told once" test "$("$raymoval" compare run reference --time-band 3 2>/dev/null | grep -c with-times)" -eq 1
expect 0 "with its times" compare run timed --update --with-times
expect 0 "1.00 times" compare run timed --time-band 3
expect 2 "--with-times needs --update" compare run timed --with-times
expect 2 "--update compares nothing" compare run timed --update --across parameters
expect 2 "two results" compare run
expect 2 "no such run folder" compare run nowhere
for wrong in F1 =1 F1=x F1=-1; do expect 2 "METRIC=NUMBER" compare run reference --tolerance $wrong; done
expect 2 "Did you mean 'F1'" compare run reference --tolerance F2=1
expect 2 "at least 1" compare run reference --time-band 0.5
"$raymoval" run "${short[@]}" --method raymoval:online --set raymoval.tau0=0.4 --out other_tau \
  >out.txt 2>err.txt
expect 2 "parameter tau0 is 0.4, the reference has 0.2" compare other_tau reference
expect 2 "--across parameters compares the rates" compare other_tau reference
expect 0 "parameter tau0 is 0.4, the reference has 0.2" compare other_tau reference \
  --across parameters --tolerance F1=1
expect 2 "Did you mean 'parameters'" compare other_tau reference --across parameter
expect 2 "Did you mean 'junit'" compare run reference --format junt
for format in text md junit; do
  expect 2 "street / raymoval:online" compare other_tau reference --format $format -o compared.$format
  holds "a comparison is written as $format" grep -q "raymoval:online" compared.$format
done
expect 2 "nowhere" compare run reference -o nowhere/compared.txt
python3 -c 'import xml.etree.ElementTree as x; assert x.parse("compared.junit").getroot().get("errors") == "1"' ||
  complain "compared.junit is no XML with one error"
"$raymoval" run --sequence street --frames 0:1 --quiet --method raymoval:online \
  --set raymoval.tau0=0.2 --out other_frames >out.txt 2>err.txt
expect 2 "data fingerprint" compare other_frames reference

# No output replaces an input, a record of a run, or any file without --overwrite.
there="is there already; choose another name, or replace it with --overwrite"
expect 2 "-o compared.text: $there" compare other_tau reference -o compared.text
expect 2 "street / raymoval:online" compare other_tau reference -o compared.text --overwrite
for record in results.json run.json results.csv cells/street/noop.html; do
  expect 2 "-o run/$record: is a record of a run" compare run reference -o run/$record --overwrite
done
expect 2 "-o reference/results.json: is read as an input" \
  compare run reference -o reference/results.json --overwrite
expect 2 "other_frames/results.json: is a record of a run" compare run other_frames --update

# BibTeX: this program first, then each paper once.
expect 0 "@software{raymoval" cite
expect 0 "lim2021erasor" cite erasor:general octomap protocol:erasor
cp out.txt cited.bib
holds "each paper once" test "$(grep -c '^@' cited.bib)" -eq 3
holds "a protocol of a method's name can be meant" grep -q zhang2023benchmark <("$raymoval" cite protocol:dynamicmap)
expect 0 "@misc{raymoval2025" cite run
cp out.txt cited.bib
holds "a run cites its protocols" grep -q "lim2021erasor" cited.bib
expect 2 "Did you mean 'octomap'" cite octmap
holds "every method is cited or is ours" test -z \
  "$("$raymoval" cite $("$raymoval" list methods | awk '/^[a-z_-]+ / { print $1 }' | grep -v -e ':' -e '^external$') | grep '^%')"

# Scores of kept removals are those of the run.
expect 0 "PR" score "${short[@]}" --predictions $cell/removals --json score.json
expect 2 "--json score.json: $there" score "${short[@]}" --predictions $cell/removals --json score.json
expect 2 "--json $cell/removals/000000.label: is a record of a run" \
  score "${short[@]}" --predictions $cell/removals --json $cell/removals/000000.label --overwrite
cp -r $cell/removals predictions
expect 2 "--json predictions/000000.label: is read as an input" \
  score "${short[@]}" --predictions predictions --json predictions/000000.label --overwrite
counts() { sed -n '/"counts"/,/}/p' "$1"; }
holds "score gives the counts of the run" diff <(counts score.json | tr -d ' ') \
  <(counts $cell/cell.json | tr -d ' ')
expect 2 "--predictions" score "${short[@]}"
expect 2 "no such folder" score "${short[@]}" --predictions nowhere
expect 2 "removals/ does" score "${short[@]}" --predictions $cell
expect 2 "is not a folder" score "${short[@]}" --predictions $cell/removals/000000.label
expect 2 "is a folder" score "${short[@]}" --cloud $cell/removals
expect 2 "put -o before it" clean street map.pcd
expect 2 "missing" score --sequence street --frames 0:3 --quiet --predictions $cell/removals
expect 0 "SA" score "${short[@]}" --predictions $cell/removals --protocol dynamicmap \
  --set dynamicmap.distance=0.1
expect 2 "'distance'" score "${short[@]}" --predictions $cell/removals --protocol dynamicmap \
  --set dynamicmap.distanc=0.1

# A cleaned map is beside the oracle's; a broken map has no points.
expect 0 "removed" clean street --frames 0:2 --quiet -o clean.pcd
expect 0 "the oracle's cloud, scored in the same way: PR" score "${short[@]}" --cloud clean.pcd --protocol erasor --protocol dynamicmap
expect 0 "precision" score "${short[@]}" --cloud clean.pcd --voxel 0.1
expect 0 "all points, only thinned, scored in the same way: PR" score "${short[@]}" --cloud clean.pcd --voxel 0.2
# The oracle is no upper limit: without a point, every moving one is gone.
"$raymoval" clean street --frames 0:30 --method remove-all --quiet -o nothing.bin >/dev/null
expect 0 "DA above the oracle's, which is not an upper limit" score --sequence street --frames 0:30 --quiet \
  --cloud nothing.bin --protocol dynamicmap
printf '\x00\x00\xc0\x7f%.0s' 1 2 3 4 >nan.bin
expect 0 "not finite" score "${short[@]}" --cloud nan.bin
: >empty.bin
expect 0 "PR 0.000" score "${short[@]}" --cloud empty.bin
expect 2 "exclude" score "${short[@]}" --cloud clean.pcd --predictions $cell/removals
expect 2 "--cloud" score "${short[@]}" --voxel 0.1 --predictions $cell/removals
truncate -s -4 $cell/removals/000001.label
expect 2 "000001.label" score "${short[@]}" --predictions $cell/removals

# Damaged results are noticed.
sed 's/"ok"/"OK"/' run/results.json >changed.json
cp -r run damaged
cp changed.json damaged/results.json
expect 2 "checksum" table damaged
head -c 1000 run/results.json >damaged/results.json
expect 2 "not a whole result file" table damaged
rm damaged/results.json
expect 2 "did not reach its end" table damaged
mkdir other
echo "mine" >other/notes.txt
expect 2 "holds other files" run "${short[@]}" --method noop --out other

# Suite files.
cat >suite.json <<'JSON'
{
  // Comments are fine.
  "name": "two",
  "sequences": [{"path": "street", "name": "a", "frames": "0:1"},
                {"path": "street", "name": "b", "frames": "2:3"}],
  "methods": ["noop", {"method": "raymoval:online", "set": {"tau0": 0.5}, "as": "high"}],
  "protocols": ["erasor"],
  "threads": 2
}
JSON
expect 0 "high" run suite.json --quiet --out suite
holds "both sequences have cells" test -s suite/cells/a/high/cell.json -a -s suite/cells/b/high/cell.json
expect 2 "--method" run suite.json --method noop --out suite2
echo '{"sequences": ["street"], "methods": ["noop"], "protocol": []}' >bad.json
expect 2 "Did you mean 'protocols'" run bad.json --out suite2
echo '{"sequences": ["street",], "methods": ["noop"]}' >bad.json
expect 2 "line 1" run bad.json --out suite2
echo '{"sequences": ["street", "street"], "methods": ["noop"]}' >bad.json
expect 2 "two sequences" run bad.json --out suite2

# Sweeps and data of one's own.
cat >sweep.json <<'JSON'
{ "sequences": [{"path": "street", "frames": "0:1"}],
  "methods": [{"method": "raymoval:online", "set": {"tau1": {"sweep": [0.1, 0.35]}}}] }
JSON
expect 0 "raymoval:online:tau1=0.35" run sweep.json --quiet --out sweep
holds "each point has a cell" test -s sweep/cells/street/raymoval-online-tau1=0.35/cell.json
expect 0 "Sweep of raymoval:online over tau1 by protocol erasor" table sweep
cp out.txt told.txt
holds "a point says what was set" grep -q "^| tau1=0.35 " told.txt
expect 2 "sweeps this parameter" run sweep.json --set raymoval.tau1=0.2 --out sweep
expect 2 "--data ROOT" run semantickitti --out kitti
expect 2 "--data is given" run sweep.json --data . --out kitti
expect 2 "--data needs" run "${short[@]}" --method noop --data . --out kitti
semantickitti=$(suite_anywhere semantickitti)
expect 2 "holds no folder sequences/" run "$semantickitti" --data "$work" --out kitti
mkdir -p root/sequences
expect 2 "kitti-00" run "$semantickitti" --data root --out kitti
holds "no refused run made a folder" test ! -e kitti

# The cells of one folder belong together: new cells are added to existing cells, and another suite,
# or other data under the same name, is refused.
expect 0 "raymoval:online" run "${short[@]}" --method raymoval:online --out together
"$raymoval" run --sequence street --frames 0:2 --method octomap --out together >out.txt 2>log.txt
holds "kept cells are logged as kept" grep -qE 'street +noop:default .*\(kept\)$' log.txt
holds "and those of earlier runs too" grep -qF 'kept of earlier runs on street: raymoval:online' \
  log.txt
holds "an added method leaves the others in the tables" grep -q '^street,raymoval,online' \
  together/results.csv
expect 0 "raymoval:online" table together
cp together/results.json before.json
expect 2 "suite 'two' (2 sequences, 4 methods)" run sweep.json --quiet --out suite
expect 2 'frames was "0:2:1", is "0:1:1"' run --sequence street --frames 0:1 --quiet \
  --method octomap --out together
expect 2 "this run by dynamicmap" run "${short[@]}" --method octomap --protocol dynamicmap \
  --out together
expect 0 "But the run is refused" run "${short[@]}" --method octomap --range 0:20 --explain \
  --out together
holds "a refused run changes nothing" cmp before.json together/results.json
expect 0 "octomap:r20" run "${short[@]}" --method octomap --range 0:20 --overwrite --out together
holds "--overwrite replaces the tables" test -z "$(grep raymoval together/results.csv)"

# Threads never change what is stored outside "measured".
for threads in 1 2; do
  "$raymoval" run "${short[@]}" --method raymoval:online --threads $threads --out t$threads >/dev/null
  sed '/"measured": {/,/^  }/d; /"checksum"/d' t$threads/cells/street/raymoval-online/cell.json \
    >t$threads.json
done
holds "one thread and two give the same cell" cmp t1.json t2.json

# Cleaning.
for extension in pcd ply bin; do
  expect 0 "removed" clean street --frames 0:2 --quiet --method raymoval:online -o map.$extension
  holds "map.$extension is there" test -s map.$extension
done
expect 0 "removed" clean street --frames 0:2 --quiet --method remove-all --voxel 0.5 \
  -o none.pcd --dynamic all.pcd --labels labels
holds "labels are written" test -s labels/000002.label
expect 2 "-o FILE" clean street
expect 2 "there is no folder" clean street -o nowhere/map.pcd
expect 2 ".pcd" clean street -o map.xyz
expect 2 "--voxel" clean street -o map2.pcd --voxel 0
expect 2 "same file" clean street -o map2.pcd --dynamic map2.pcd
holds "no refused map was written" test ! -e map2.pcd
expect 2 "same file" clean street -o map2.pcd --dynamic ./map2.pcd
# Existing files are kept unless --overwrite is given; the same run gives the same bytes.
online=(clean street --frames 0:2 --quiet --method raymoval:online)
expect 2 "--overwrite" "${online[@]}" -o map.pcd
expect 2 "--overwrite" "${online[@]}" -o new.pcd --dynamic map.ply
expect 2 "--overwrite" "${online[@]}" -o new.pcd --labels labels
cp map.pcd before.pcd
expect 0 "removed" "${online[@]}" -o map.pcd --labels labels --overwrite --threads 2
holds "the same run gives the same map" cmp map.pcd before.pcd
touch labels/notes.txt
expect 2 "not a label file" "${online[@]}" -o new.pcd --labels labels --overwrite
# A disk with room for 64 KiB in each file: the map stays as it was and nothing else is left.
checks=$((checks + 1))
# (A program that counts its lines for coverage must not write its counts under that limit.)
(trap '' XFSZ; ulimit -f 64; GCOV_PREFIX=$work/counts "$raymoval" "${online[@]}" -o map.pcd --overwrite 2>full.txt)
[[ $? -eq 2 ]] || complain "a full disk: exit code 2"
holds "a full disk is told" grep -q "cannot be written" full.txt
holds "a full disk leaves the map" cmp map.pcd before.pcd
holds "nothing is left beside the maps" test -z "$(find . -name '*.part*')"
# Maps do not go among scans, nor labels over the truth.
mkdir scans && cp map.bin scans/1.bin && echo "1 0 0 0 0 1 0 0 0 0 1 0" >scans/poses.txt
expect 2 "in the folder of the scans" clean scans --quiet --method noop -o scans/static.pcd
expect 0 "removed" clean scans --quiet --method noop -o of_scans.pcd
# 16 bytes a point in both, and less than 400 for the head.
more=$(($(stat -c %s of_scans.pcd) - $(stat -c %s map.bin)))
holds "the map has every point of its scan" test $more -gt 200 -a $more -lt 400

# Simulated scenes: written to a folder, and used by name through the cache.
export RAYMOVAL_CACHE=$work/cache
tiny=(--scans 2 --sensor vlp16 --quiet)
expect 0 "2 scans" simulate town -o sim/town "${tiny[@]}" --seed 3 --threads 1
for file in velodyne/000001.bin labels/000001.label poses.txt calib.txt sequence.json; do
  holds "a simulated sequence has $file" test -s sim/town/$file
done
expect 2 "the ground-truth labels" clean sim/town --method noop --quiet -o town_map.pcd \
  --labels sim/town/labels --overwrite
mkdir empty
expect 0 "2 scans" simulate town -o empty "${tiny[@]}" --seed 3 --threads 2
holds "the same options give the same bytes" diff -r sim/town empty
expect 0 "2 scans" simulate town -o seed4 "${tiny[@]}" --seed 4
holds "another seed gives other scans" test "$(cmp -s sim/town/velodyne/000001.bin \
  seed4/velodyne/000001.bin; echo $?)" -eq 1
expect 2 "not an empty folder" simulate town -o sim/town "${tiny[@]}"
expect 2 "Did you mean 'town'" simulate tow -o other_sim "${tiny[@]}"
expect 2 "Did you mean 'vlp16'" simulate town -o other_sim --sensor vlp1
expect 2 "'skewed'" simulate town -o other_sim --rolling skew
expect 2 "contradict" simulate town -o other_sim --perfect-poses --pose-noise 1
for wrong in "--scans 0" "--scans two" "--seed -1" "--pose-noise -1" "--threads 0"; do
  # shellcheck disable=SC2086
  expect 2 "${wrong% *}" simulate town -o other_sim $wrong
done
expect 2 "SCENE is missing" simulate -o other_sim
expect 2 "-o DIR" simulate town
holds "no refused simulation left a folder" test ! -e other_sim
holds "nothing half written is left" test -z "$(find . -name '*.part')"
expect 0 "All controls have their expected scores" run --sequence sim/town --method noop --quiet \
  --out run_folder
expect 0 "All controls have their expected scores" run --quiet --method noop \
  --sequence town:scans=2,sensor=vlp16,seed=3 --out run_scene
fingerprint() { grep -o '"fingerprint": "[^"]*"' "$1/cells/town/oracle-default/cell.json"; }
holds "a cell tells its data's fingerprint" test -n "$(fingerprint run_folder)"
holds "a scene by name is what simulate writes" test "$(fingerprint run_folder)" = \
  "$(fingerprint run_scene)"
holds "the record tells scene and seed" grep -q 'scene town, sensor vlp16, seed 3' \
  run_scene/run.json
cp -r sim/town relabelled
printf '\xfc\x00\x00\x00' | dd of=relabelled/labels/000001.label conv=notrunc 2>/dev/null
expect 2 "its scans, poses or labels differ" run --sequence relabelled --name town --method noop \
  --quiet --out run_folder
stamp=$(find cache -exec stat -c '%n %y' {} + | sort)
expect 0 "removed" clean town:scans=2,sensor=vlp16,seed=3 --method noop --quiet -o town.pcd
holds "what is in the cache is not made again" test "$stamp" = \
  "$(find cache -exec stat -c '%n %y' {} + | sort)"
for wrong in "town:scan=2 'scans'" "town:scans=x town:scans=x" "town:scans=2,scans=3 twice" \
  "town:05 key=value" "suburbs 'suburb'"; do
  expect 2 "${wrong#* }" run --sequence "${wrong% *}" --method noop --quiet --out other_sim
done
expect 2 "Did you mean 'simulated'" run simulatd --out other_sim

# Inspecting: silent on good data, a finding has a line of its own, exit codes 0, 1, 2.
expect 0 "0 findings" inspect sim/town --quiet
expect 0 "sensor vlp16; the scans show 16 beams, 0.200 deg by 2.00" inspect sim/town --quiet
"$raymoval" inspect sim/town --sensor hdl64e --quiet >found.txt 2>err.txt
holds "a sensor named by mistake is a finding" grep -q "^finding other-sensor: sensor 'hdl64e': " found.txt
expect 0 "sensor estimated: 16 beams, 0.200 deg by 2.00" inspect sim/town --sensor estimated --quiet
expect 0 "town: sensor estimated: 16 beams, 0.200 deg by 2.00" run --method noop \
  --sequence sim/town --sensor estimated --out run_estimated
holds "a cell tells what an estimated sensor rests on" grep -q '"sensor_basis": "16 beams, ' \
  run_estimated/cells/town/noop-default/cell.json
expect 0 "poses-inverted" inspect --list
expect 0 '"findings": []' inspect sim/town --json --quiet
cp -r sim/town shortened
cp shortened/velodyne/000001.bin shortened/velodyne/000002.bin
"$raymoval" inspect shortened --quiet >out.txt 2>err.txt
holds "an inspection with findings exits with 1" test $? -eq 1
"$raymoval" inspect shortened --quiet >found.txt 2>err.txt
holds "a finding is named" grep -q '^finding poses-of-another-sequence: poses.txt: .* Take the' found.txt
expect 2 "no such folder" inspect nowhere
for input in poses.txt calib.txt labels/000000.label velodyne/000000.bin; do
  cp sim/town/$input kept.input
  expect 2 "--json sim/town/$input: is read as an input" score sim/town --predictions sim/town/labels \
    --json sim/town/$input --overwrite --quiet
  holds "$input stays" cmp kept.input sim/town/$input
done
expect 2 "PATH is missing" inspect
expect 2 "--point-time-unit min: expected s, ms, us, ns" inspect sim/town --point-time-unit min
expect 2 "sim/town." inspect sim/town/velodyne
expect 2 "is a scan" inspect sim/town/velodyne/000000.bin
expect 2 "Did you mean '--json'" inspect sim/town --jason

# Pictures: of points and of numbers, and what is missing for them.
is_png() { [[ $(head -c 8 "$1" | od -An -tx1 | tr -d ' \n') == 89504e470d0a1a0a ]]; }
expect 0 "" run "${short[@]}" --method raymoval:online --keep-removals --out shown
expect 0 "" picture shown -o map.png --quiet
holds "a map is a PNG" is_png map.png
expect 0 "" picture shown -o detail.png --only 'street/raymoval*' --crop -10:20:-8:8 \
  --resolution 0.25 --quiet
holds "a detail is a PNG" is_png detail.png
cp map.png before.png
expect 0 "" picture shown -o map.png --overwrite --quiet --threads 1
holds "the same run gives the same picture" cmp before.png map.png
for kind in pr-rr accuracy-time; do
  expect 0 "" picture shown -o $kind.svg --kind $kind
  holds "$kind is an SVG" grep -q '^<svg xmlns="http://www.w3.org/2000/svg"' $kind.svg
done
expect 2 "no method has what --kind sweep shows" picture shown -o sweep.svg --kind sweep
expect 2 "RUN is missing" picture -o map.png --overwrite
expect 2 "-o FILE.png" picture shown
expect 2 "no such run folder" picture nowhere -o map.png --overwrite
expect 2 "Did you mean 'sweep'" picture shown -o map.png --overwrite --kind swep
expect 2 ".svg" picture shown -o map.jpg --kind pr-rr
expect 2 "--protocol needs a chart" picture shown -o map.png --overwrite --protocol erasor
expect 2 "--crop needs --kind map" picture shown -o a.svg --kind pr-rr --crop 0:1:0:1
expect 2 "XMIN:XMAX:YMIN:YMAX" picture shown -o map.png --overwrite --crop 5:1:0:1 --quiet
expect 2 "--crop 1000:2000:1000:2000: no point lies there" \
  picture shown -o map.png --overwrite --crop 1000:2000:1000:2000 --quiet
expect 2 "--size" picture shown -o map.png --overwrite --size 7 --quiet
expect 2 "coarser --resolution" picture shown -o map.png --overwrite --resolution 0.0001 --quiet
expect 2 "matches no cell" picture shown -o map.png --overwrite --only nothing --quiet
expect 2 "--protocol" picture shown -o rates.svg --kind pr-rr --protocol erasr
expect 2 "--keep-removals" picture run_scene -o map.png --overwrite --only '*' --quiet
expect 2 "nothing but controls" picture run_scene -o map.png --overwrite --quiet
RAYMOVAL_FONT=nowhere.ttf expect 2 "nowhere.ttf" picture shown -o map.png --overwrite --quiet
mv sim/town sim/elsewhere
expect 0 "" run --sequence sim/elsewhere --name town --method noop --quiet --keep-removals --out kept
mv sim/elsewhere sim/town
expect 2 "--data" picture kept -o map.png --overwrite --only '*' --quiet
expect 0 "" picture kept -o map.png --overwrite --only '*' --quiet --data sim
expect 0 "" picture kept -o map.png --overwrite --only '*' --quiet --data sim/town
expect 2 "fingerprint" picture kept -o map.png --overwrite --only '*' --quiet --data seed4

# On a terminal, one line shows cell, stage, scans done; a log has only finished steps; --quiet has no
# output. A narrow terminal truncates the line.
live() { script -qec "$*" /dev/null 2>&1 | tr -d '\r'; }
if command -v script >/dev/null; then
  live "$raymoval" run --sequence street --frames 0:4 --method raymoval:offline --out live >live.txt
  holds "a live line names cell, stage and scans" \
    grep -qF '[4/4] raymoval:offline on street: raymoval: ' live.txt
  holds "a live line counts scans" grep -qF ': 0 of 5' live.txt
  live "stty cols 30; $raymoval" clean street --method noop --frames 0:3 -o live.pcd >live.txt
  holds "clean has one, without its context where the terminal is narrow" \
    grep -qF 'masks: 0 of 4' live.txt
  holds "nothing is wider than the terminal" test -z "$(grep -F 'noop:default on street: masks' \
    live.txt)"
  live "$raymoval" simulate town --scans 2 --sensor vlp16 -o live_town >live.txt
  holds "simulate has one" grep -qF 'simulating town: 0 of 2' live.txt
  live "$raymoval" clean street --method noop --frames 0:3 -o live.pcd --overwrite --quiet >live.txt
  holds "--quiet has none" test -z "$(grep -F ' of 4' live.txt)"
fi
"$raymoval" run --sequence street --frames 0:2 --method noop --out log_run >told.txt 2>log.txt
holds "a log has a line for each cell" test "$(grep -c '^\[[1-3]/3\] ' log.txt)" -eq 3
holds "and nothing else" test "$(wc -l <log.txt)" -eq 3
holds "F1 comes first, in one width" test "$(grep -cE '^\[[1-3]/3\] street  .{18}  F1 ' log.txt)" -eq 3
holds "the end of a run fits a screen" test "$(wc -L <told.txt)" -le 100 -a "$(wc -l <told.txt)" -le 40 \
  -a -s told.txt

# An interrupted run ends by itself and can be resumed. It has more work than can be done before the
# signal, even if that is late.
"$raymoval" run --sequence street --quiet --method all --out stopped >out.txt 2>err.txt &
process=$!
finished=stopped/cells/street/oracle-default/cell.json
wait_for $finished $process
# A shell's background jobs ignore SIGINT unless they install a handler, as the program does.
kill -INT $process
wait $process
holds "an interrupted run exits with 130" test $? -eq 130
holds "finished cells stay" test -s $finished
holds "nothing claims to be complete" test ! -e stopped/results.json

finish cli
