#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# `--poses estimate`, `--poses refine` and `--write-poses`: scans alone become a map, and what does not
# work is said with a remedy. Usage: poses_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
export RAYMOVAL_CACHE=$work/cache

sparse_vlp16 >sparse.json
expect 0 "14 scans" simulate suburb -o drive --scans 14 --sensor sparse.json --seed 5 \
  --perfect-poses --quiet
mkdir scans
cp drive/velodyne/*.bin scans
online=(--method raymoval:online --quiet)

# Scans alone: the message names the option, and the option works.
expect 2 "To estimate them from the scans, use --poses estimate" clean scans "${online[@]}" -o map.pcd
expect 0 "The poses are estimated from the scans: a path of 7.9 m" \
  clean scans --poses estimate "${online[@]}" -o map.pcd --write-poses poses.tum --scans cleaned
expect 0 "poses fit to 0.00" inspect cleaned --quiet
expect 2 "there already" clean scans --poses estimate "${online[@]}" -o b.pcd --write-poses poses.tum

# The file opens by itself, also beside the calibration of a camera.
expect 0 "poses fit to 0.00" inspect scans --poses poses.tum --quiet
expect 0 "poses fit to 0.00" inspect drive --poses ../poses.tum --quiet
expect 0 "poses fit to 0.00" inspect scans --poses estimate --quiet --write-poses rows_kitti.txt
holds "KITTI's rows have 12 numbers" test "$(awk 'NF != 12' rows_kitti.txt | wc -l)" = 0

# The same poses for one thread and for three.
expect 0 "" inspect scans --poses estimate --threads 1 --quiet --write-poses one.tum
expect 0 "" inspect scans --poses estimate --threads 3 --quiet --write-poses three.tum
holds "threads do not change poses" cmp one.tum three.tum

# Poses with a jump of 2 m are refused, and refined poses are not.
awk '/^#/ { print; next } NR > 7 { $2 += 1.2; $3 += 1.6 } { print }' poses.tum >jump.tum
expect 0 "The poses are refined: moved by" inspect scans --poses refine:jump.tum --quiet
expect 0 "The given poses are kept" inspect drive --poses refine --quiet

# What does not work.
expect 2 "--T-sensor has no effect with --poses estimate" \
  inspect scans --poses estimate --T-sensor 0,0,0,0,0,0,1 --quiet
expect 2 "are in the world frame" inspect scans --poses estimate --points world --quiet
expect 2 "missing.txt" inspect scans --poses refine:missing.txt --quiet
expect 0 "14 scans" simulate warehouse -o other --scans 14 --sensor sparse.json --perfect-poses --quiet
cp other/velodyne/000013.bin scans/000014.bin
expect 2 "scan 000014: does not overlap enough with the scans before it" \
  clean scans --poses estimate "${online[@]}" -o c.pcd
holds "nothing is written" test ! -e c.pcd
finish poses
