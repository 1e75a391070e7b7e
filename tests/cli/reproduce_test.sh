#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# scripts/reproduce.sh says which files of SemanticKITTI are missing before it does anything else.
set -uo pipefail
raymoval=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../../scripts/reproduce.sh")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

# says CODE TEXT ARGUMENTS...: as `expect`, for the script.
says() {
  checks=$((checks + 1))
  "$raymoval" "${@:3}" >out.txt 2>err.txt
  local got=$?
  [[ $got -eq $1 ]] && cat out.txt err.txt | grep -qF -- "$2" ||
    complain "reproduce.sh ${*:3}: exit code $got, expected $1 and '$2'"
}

says 2 "say where the data is" semantickitti
says 2 "'kitti' is unknown" kitti
says 2 "missing: $work/root/sequences/00/ (sequence 00, frames 4390 to 4530)" semantickitti root --check
for segment in "00 4390 4530 2" "01 150 250 1" "02 860 950 2" "05 2350 2670 2" "07 630 820 2"; do
  read -r sequence first last stride <<<"$segment"
  mkdir -p root/sequences/"$sequence"/{velodyne,labels}
  for frame in $(seq -f %06g "$first" "$stride" "$last"); do
    echo x >root/sequences/"$sequence"/velodyne/"$frame".bin
    echo x >root/sequences/"$sequence"/labels/"$frame".label
  done
  echo x >root/sequences/"$sequence"/poses.txt
  echo x >root/sequences/"$sequence"/calib.txt
done
says 0 "sequence 07, frames 630:820:2: all there" semantickitti root --check
rm root/sequences/02/velodyne/000950.bin root/sequences/07/poses.txt
: >root/sequences/05/labels/002350.label
rm root/sequences/05/labels/002670.label
says 2 "missing: $work/root/sequences/02/velodyne/000950.bin" semantickitti root --check
says 2 "sequence 00, frames 4390:4530:2: all there" semantickitti root --check
says 2 "missing: $work/root/sequences/07/poses.txt" semantickitti root --check
says 2 "002350.label and 1 more of labels/ up to frame 2670" semantickitti root
says 2 "SemanticKITTI label data" semantickitti root
finish reproduce
