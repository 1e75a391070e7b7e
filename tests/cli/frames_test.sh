#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Where the origin of a sequence's world lies and which way its axes point changes no result.
# Usage: frames_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
export RAYMOVAL_CACHE=$work/cache

# moved FROM DIR AWK-PROGRAM: the data of FROM with other poses, which are the LiDAR's.
moved() {
  mkdir "$2"
  ln -s "../$1/velodyne" "../$1/labels" "../$1/times.txt" "$2"
  sed 's/^{/{ "poses_are_lidar": true,/' \
    scene/sequence.json >"$2/sequence.json"
  awk "$3" "$1/poses.txt" >"$2/poses.txt"
}
numbers='{ for (i = 1; i <= 12; ++i) printf "%.9f%s", p[i], i < 12 ? " " : "\n" }'
sparse_vlp16 >sparse.json
expect 0 "12 scans" simulate suburb -o scene --scans 12 --sensor sparse.json --quiet
# Poses of a camera become those of the LiDAR: Tr^-1 P Tr.
moved scene near "BEGIN {
    while ((getline row < \"scene/calib.txt\") > 0) if (row ~ /^Tr:/) split(substr(row, 5), c)
  }
  {
    split(\$0, q)
    for (i = 0; i < 3; ++i) for (j = 1; j <= 4; ++j) {
      m[4 * i + j] = j == 4 ? q[4 * i + 4] - c[4 * i + 4] : 0
      for (k = 1; k <= 3; ++k) m[4 * i + j] += q[4 * i + k] * c[4 * (k - 1) + j]
    }
    for (i = 0; i < 3; ++i) for (j = 1; j <= 4; ++j) {
      p[4 * i + j] = 0
      for (k = 0; k < 3; ++k) p[4 * i + j] += c[4 * k + i + 1] * m[4 * k + j]
    }
  }
  $numbers"
moved near far "{ split(\$0, p); p[4] += 691000; p[8] += 5336000; p[12] += 1000 } $numbers"
moved near down "{ split(\$0, q); for (i = 1; i <= 4; ++i) {
  p[i] = q[i]; p[4 + i] = -q[8 + i]; p[8 + i] = q[4 + i] } } $numbers"

# UTM coordinates: the same masks and counts, silence from `inspect`, maps without lost digits.
methods=()
for method in raymoval_plus raymoval erasor dufomap octomap peopleremover removert; do
  methods+=(--method "$method")
done
protocols=(--protocol erasor --protocol dynamicmap --protocol dynamicmap-strict)
for place in near far; do
  expect 0 "" run --sequence "$place" --name suburb "${methods[@]}" "${protocols[@]}" --quiet --out "run_$place"
done
counts() { grep -hE '"(static|dynamic|preserved|remaining|removed|kept)[a-z_]*": [0-9]+' "run_$1"/cells/*/*/cell.json; }
holds "counts far away are those near by" diff <(counts near) <(counts far)
holds "there are counts" test "$(counts near | wc -l)" -gt 50
expect 0 ": 0 findings (" inspect far --quiet
expect 2 "a .bin file holds float32 numbers only" clean far -o map.bin --method octomap --quiet
holds "nothing is left" test ! -e map.bin
expect 0 "its coordinates are float64" clean far -o map.pcd --method octomap --quiet
holds "the map has float64" grep -qa '^SIZE 8 8 8 4' map.pcd
expect 0 "cloud of" score --sequence far --cloud map.pcd --quiet
grep -E ' (PR|RR) ' out.txt >far.txt
expect 0 "octomap:r20 removed" clean near -o near.pcd --method octomap --quiet
holds "a map near by has float32" grep -qa '^SIZE 4 4 4 4' near.pcd
expect 0 "cloud of" score --sequence near --cloud near.pcd --quiet
grep -E ' (PR|RR) ' out.txt >near.txt  # Not within `holds`, which writes out.txt itself.
holds "the map scores as near by" diff far.txt near.txt

# Axes: y down. This is detected, reported and recorded, and every mask is the same.
expect 0 "note world-axes: poses.txt" inspect down --quiet
expect 0 "suburb: up is -y of the world (estimated" run --sequence down --name suburb "${methods[@]}" --out run_down
digests() { grep -h '"digest"' "run_$1"/cells/*/*/cell.json; }
holds "masks are those of the upright world" diff <(digests near) <(digests down)
holds "up is recorded" grep -q '"up": "-y"' run_down/cells/suburb/raymoval_plus-offline/cell.json
expect 0 "up is -y of the world (estimated" clean down -o down.ply --method octomap

# The user's value takes precedence, and gives other cells.
expect 2 "--up sideways: expected an axis of the world" inspect near --up sideways
"$raymoval" inspect near --up -y --quiet >contradicted.txt
holds "a wrong --up is a finding" grep -q '^finding up-contradicted' contradicted.txt
expect 0 "data up was \"-y\", is \"z\"" run --sequence down --name suburb --method octomap --up z --out run_down --explain
expect 0 "up is x of the world (as given)" run --sequence near --method noop --up 1,0,0 --out run_x
sed -i 's/^{/{ "up": "x",/' near/sequence.json
expect 0 "up is x of the world (as given)" run --sequence near --method noop --out run_x

finish frames
