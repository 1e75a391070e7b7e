#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What `raymoval clean` refuses, warns of and leaves behind, and what no method gets to see.
# Usage: clean_test.sh PATH/TO/raymoval_faulty
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
export RAYMOVAL_CACHE=$work/cache

nothing_left() {
  holds "$1 leaves nothing" test -z "$(find . -name 'map*' -o -name '*.part' -o -name labels_out)"
}

sparse_vlp16 >sparse.json
expect 0 "12 scans" simulate suburb -o drive --scans 12 --sensor sparse.json --seed 5 --quiet
online=(--method raymoval:online --quiet)
expect 0 "raymoval:online removed" clean drive "${online[@]}" -o good.pcd
cp err.txt said.txt
holds "nothing is said of good data" test ! -s said.txt

# Points in millimetres: refused at once and with the finding, in spite of any memory.
cp -r drive millimetres
for scan in millimetres/velodyne/*.bin; do
  perl -e 'binmode STDIN; binmode STDOUT; local $/; @v = unpack("f<*", <STDIN>);
    for $i (0..$#v) { $v[$i] *= 1000 if $i % 4 != 3 } print pack("f<*", @v)' <"$scan" >scan.bin
  mv scan.bin "$scan"
done
expect 2 "points-in-millimetres: points of all scans read: half of the points" \
  clean millimetres -o map.pcd --labels labels_out --quiet
cp err.txt said.txt
holds "the remedy is said" grep -q "Multiply the coordinates by 0.001." said.txt
holds "and how to go on" grep -q -- "--force cleans it nevertheless" said.txt
nothing_left "a refusal"

# Poses of a camera read as the LiDAR's.
cp -r drive frames
sed -i 's/"poses"/"poses_are_lidar": true, "poses"/' frames/sequence.json
expect 2 "camera-frame: poses.txt" clean frames -o map.pcd --quiet
nothing_left "a refusal of poses"
expect 0 "warning: continuing because of --force, in spite of camera-frame" \
  clean frames "${online[@]}" -o forced.pcd --force
expect 0 "poses-inverted: poses transform from the world to the sensor (T_sensor_world). (clean refuses it)" \
  inspect --list
expect 0 "few-points: a scan has far fewer points than those around it. (clean warns)" inspect --list

# A file that is truncated at a whole point is reported, and still cleaned.
cp -r drive cut
rm -r cut/labels
truncate -s $((16 * 5000)) cut/velodyne/000007.bin
expect 0 "warning: few-points: 000007.bin" clean cut "${online[@]}" -o cut.pcd
holds "inspect finds it" grep -q "^finding few-points: 000007.bin" <("$raymoval" inspect cut --quiet)

# Results that are worth a look.
expect 0 "warning: nothing was removed" clean street --frames 0:1 "${online[@]}" -o none.pcd
expect 0 "warning: more than half of all points were removed" \
  clean street --frames 1:1 --method comb --set comb.milliseconds=0 --quiet -o half.pcd

# --caution: the more, the fewer points are removed.
expect 2 "--caution 1.5: expected a number from 0" clean drive --caution 1.5 -o map.pcd
expect 2 "--caution: raymoval has no confidence. Choose another --method" \
  clean drive --method raymoval --caution 0.5 -o map.pcd
removed=()
for caution in 0 0.5 1; do
  expect 0 "raymoval_plus:offline, caution $caution removed" \
    clean drive --caution $caution --quiet --labels caution$caution
  removed[${#removed[@]}]=$(cat caution$caution/*.label | od -An -v -tu4 -w4 | grep -c '^ *251$')
done
holds "more caution removes less" test "${removed[0]}" -ge "${removed[1]}" -a "${removed[1]}" -gt "${removed[2]}"

# --edits: the answer that a page holds, without corrections and with one.
expect 0 "" clean drive --quiet --html reviewed.html --labels reviewed
edits_of reviewed.html >same.json
edits_of reviewed.html remove=[[0,0,0]] kept_cell=1073741824 >positive.json
expect 0 "same.json: 0 removed points kept and 0 kept points removed by hand" \
  clean drive --edits same.json --quiet --labels same
holds "without corrections the answer is the method's" diff -r reviewed same
expect 0 "0 removed points kept and " clean drive --edits positive.json --quiet --labels positive
holds "a cell of all positive places removes points" test -n "$(diff -rq reviewed positive)"
expect 0 "IoU 100.000" score drive --truth same.json --predictions same --protocol mos --quiet
expect 0 "IoU 100.000" score drive --truth same.json --predictions same.json --protocol mos --quiet
for option in --method --set --caution; do
  expect 2 "has no effect with --edits" clean drive --edits same.json $option 0.5 -o map.pcd
done
expect 2 "the edits are for 12 scans of suburb, but there are 5" \
  clean drive --edits same.json --frames 0:4 --quiet -o map.pcd
expect 2 "12 of 12 scans have another pose or other points" \
  clean drive --edits same.json --drop-ego 5 --quiet -o map.pcd
expect 2 "is not a file of edits" clean drive --edits drive/sequence.json --quiet -o map.pcd
expect 2 "missing.json" clean drive --edits missing.json --quiet -o map.pcd
expect 2 "same.json" clean drive --edits same.json -o same.json --overwrite
nothing_left "a refusal of edits"

# --range: what is beyond is in no output.
expect 2 "no point lies within --range 2000:40000" \
  clean street --frames 0:2 "${online[@]}" --range 2000:40000 -o map.pcd
nothing_left "an empty range"
expect 0 "beyond --range 0:10 are in no output." clean street --frames 0:2 --method noop --quiet \
  --range 0:10 -o near.bin --labels near
expect 0 "" clean street --frames 0:2 --method noop --quiet -o far.bin
holds "the near map is smaller" test "$(stat -c %s near.bin)" -lt "$(stat -c %s far.bin)"
# words DIR: counts of the label words of all files.
words() { cat "$1"/*.label | od -An -v -tu4 -w4 | sort | uniq -c | awk '{ print $2 ":" $1 }'; }
points=$(($(stat -c %s near.bin) / 16))
holds "labels tell what is beyond" test "$(words near | grep ^9:)" = "9:$points"
holds "by 0" grep -q "^0:[1-9]" <(words near)

# --drop-ego: no method sees these points, and no output has them.
expect 0 "on the ego vehicle (nearer than 6 m) and are left out." clean street --frames 0:2 \
  --method remove-all --quiet --drop-ego 6 -o ego.pcd --labels ego
holds "labels tell what was dropped" grep -q "^0:[1-9]" <(words ego)
expect 2 "--drop-ego 'car' is not a region" clean street --drop-ego car -o map.pcd
expect 0 "street: " run --sequence street --frames 0:2 --drop-ego -9:9,-3:3,:-1 --method noop --out run
holds "run says it once" test "$(grep -c 'on the ego vehicle (in the box' err.txt)" -eq 1
holds "the record has it" grep -q '"left_out": "-9:9,-3:3,:-1"' run/cells/street/noop-default/cell.json
expect 0 "All controls" run --sequence street --frames 0:2 --drop-ego -9:9,-3:3,:-1 \
  --method comb --set comb.milliseconds=0 --keep-removals --quiet --out run
expect 0 "precision" score --sequence street --frames 0:2 --drop-ego -9:9,-3:3,:-1 --quiet \
  --predictions run/cells/street/comb-default/removals
cat >ego.json <<'JSON'
{ "sequences": [{"path": "street", "frames": "0:2", "drop_ego": "-9:9,-3:3,:-1"}],
  "methods": [{"method": "comb", "set": {"milliseconds": 0}}] }
JSON
expect 0 "0 of 4 cells" run ego.json --out run --explain
expect 0 "Leave it out with --drop-ego auto" inspect --list

# All outputs in one run. The cleaned scans open as the drive does, and hold what the map holds.
mkdir all
expect 0 "80+ m" clean drive "${online[@]}" --static all/static.pcd --dynamic all/removed.ply \
  --scans all/scans --labels all/labels --picture all/view.png
cp out.txt said.txt
holds "it says how the scans open" grep -qxF "The cleaned scans open with: raymoval inspect all/scans" said.txt
points() { grep -am1 -oE '^(POINTS|element vertex) [0-9]+' "$1" | grep -oE '[0-9]+$'; }
holds "scans and map have the same points" \
  test "$(cat all/scans/velodyne/*.bin | wc -c)" -eq $((16 * $(points all/static.pcd)))
holds "scans keep their labels" test "$(cat all/scans/labels/* | wc -c)" -eq $((4 * $(points all/static.pcd)))
holds "the two maps have all points" test $(($(points all/static.pcd) + $(points all/removed.ply))) \
  -eq $(($(cat drive/velodyne/*.bin | wc -c) / 16))
holds "it is a picture" grep -q PNG <(head -c 8 all/view.png)
expect 0 "0 findings" inspect all/scans --quiet
expect 2 "--overwrite" clean drive "${online[@]}" --scans all/scans
chmod 750 all/scans
expect 0 "" clean drive "${online[@]}" --scans all/scans --overwrite
holds "a folder keeps its rights" test "$(stat -c %a all/scans)" = 750
touch all/scans/mine.txt
expect 2 "mine.txt: was not written by" clean drive "${online[@]}" --scans all/scans --overwrite
expect 2 "was not written by" clean drive "${online[@]}" --scans drive --overwrite
ln drive/poses.txt all/poses.pcd
expect 2 "is read as an input" clean drive "${online[@]}" -o all/poses.pcd --overwrite
expect 2 "not stored in files" clean street "${online[@]}" --scans map_scans
nothing_left "a refusal of outputs"

# Confidence is behind the other fields of each map, and changes no other output.
expect 2 "raymoval has no confidence" clean drive "${online[@]}" -o sure.pcd --confidence
expect 2 "--confidence has no effect" clean drive --labels sure --confidence
sure=(--method octomap --quiet)
expect 0 "" clean drive "${sure[@]}" -o unsure.pcd
expect 0 "" clean drive "${sure[@]}" -o sure.pcd --dynamic sure.ply --confidence
holds "all points are sure" test $(($(points sure.pcd) + $(points sure.ply))) \
  -eq $(($(cat drive/velodyne/*.bin | wc -c) / 16))
holds "the decision is the same" test "$(points sure.pcd)" -eq "$(points unsure.pcd)"
holds "a field says how sure" grep -aqx "property float confidence" sure.ply
holds "nobody is sure unasked" test "$(grep -ac confidence unsure.pcd)" -eq 0

# A map in LAS has every point.
expect 0 "" clean drive "${online[@]}" -o whole.las
holds "LAS has every point" python3 - "$(points all/static.pcd)" <<'PYTHON'
import struct, sys
las = open("whole.las", "rb").read()
assert las[:4] == b"LASF" and las[24:26] == b"\1\4", "LAS 1.4"
assert struct.unpack_from("<H", las, 6)[0] & 16, "the reference system is WKT"
first, = struct.unpack_from("<I", las, 96)
points, = struct.unpack_from("<Q", las, 247)
size, = struct.unpack_from("<H", las, 105)
assert points == int(sys.argv[1]) and len(las) == first + points * size
steps, scale = struct.unpack_from("<3i", las, first), struct.unpack_from("<3d", las, 131)
offset, bounds = struct.unpack_from("<3d", las, 155), struct.unpack_from("<6d", las, 179)
for axis in range(3):
    place = steps[axis] * scale[axis] + offset[axis]
    assert bounds[2 * axis + 1] - 1e-6 <= place <= bounds[2 * axis] + 1e-6
PYTHON

# With any result, no unfinished file is left.
outputs=(-o map.pcd --dynamic map2.pcd --labels labels_out --scans map_scans --picture map.png --quiet)
expect 2 "cleaning took more than 600 MiB of memory (see --memory-limit) and was ended. Nothing was" \
  clean drive --method leak --memory-limit 600 "${outputs[@]}"
nothing_left "a leak"
expect 2 "more than 600 MiB" clean drive --method leak-child --memory-limit 600 "${outputs[@]}"
nothing_left "a leak of a child"
expect 1 "cleaning crashed: signal 11" clean drive --method crash "${outputs[@]}"
nothing_left "a crash"
expect 2 "killed from outside" clean drive --method killed "${outputs[@]}"
nothing_left "a kill"
expect 1 "cleaning ended without a map" clean drive --method quit "${outputs[@]}"
nothing_left "an end without an answer"
expect 2 "--memory-limit" clean drive --memory-limit much -o map.pcd
expect 2 "--memory-limit" inspect drive --memory-limit much
expect 2 "inspecting took more than 1 MiB of memory (see --memory-limit) and was ended. Choose fewer" \
  inspect drive --memory-limit 1
"$raymoval" clean drive --method comb --set comb.milliseconds=300 "${outputs[@]}" 2>interrupted.txt &
process=$!
until compgen -G 'map.pcd*.part' >/dev/null || ! kill -0 $process 2>/dev/null; do sleep 0.05; done
kill -INT $process
wait $process
holds "an interruption is told" test $? -eq 130 -a -n "$(grep cancelled interrupted.txt)"
nothing_left "an interruption"
finish clean
