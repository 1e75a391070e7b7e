#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# From a fresh clone to a comparison table: installs, builds, runs, prints.
#
#   scripts/reproduce.sh --quick                     one short simulated scene: ends with a table and
#                                                    a page, at most a minute after the build
#   scripts/reproduce.sh                             the suite `simulated`: six simulated scenes
#   scripts/reproduce.sh semantickitti ROOT          the paper's Tables 2 and 3 from SemanticKITTI;
#                                                    ROOT holds sequences/00, 01, 02, 05 and 07
#   scripts/reproduce.sh semantickitti ROOT --check  only lists the data that is there or missing
#   RAYMOVAL_DATA=/data/kitti:kitti-05 scripts/reproduce.sh    your own sequence, see
#                                                    `raymoval list sequences`
#   RAYMOVAL_OUT=DIR                                 where results go (default: results/run-...)
#   RAYMOVAL_JOBS=N                                  cells that run at once (default: one for each core,
#                                                    as memory allows; for SemanticKITTI 1, since its
#                                                    Table 3 is of times, and each is slower beside others)
set -euo pipefail
caller=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Relative paths start at the caller's folder.
from_caller() {
  if [[ $1 == /* ]]; then echo "$1"; else echo "$caller/$1"; fi
}

# check_segment ROOT SEQUENCE FIRST LAST STRIDE: prints missing files, one per line.
check_segment() {
  local folder=$1/sequences/$2 frame kind extension missing first_missing=
  if [[ ! -d $folder ]]; then
    echo "$folder/ (sequence $2, frames $3 to $4)"
    return
  fi
  for kind in poses.txt calib.txt; do
    [[ -s $folder/$kind ]] || echo "$folder/$kind"
  done
  for kind in velodyne:bin labels:label; do
    extension=${kind#*:}
    kind=${kind%:*}
    missing=0
    for ((frame = $3; frame <= $4; frame += $5)); do
      local file
      printf -v file '%s/%s/%06d.%s' "$folder" "$kind" "$frame" "$extension"
      [[ -s $file ]] && continue
      [[ $missing -gt 0 ]] || first_missing=$file
      missing=$((missing + 1))
    done
    case $missing in
      0) ;;
      1) echo "$first_missing" ;;
      *) echo "$first_missing and $((missing - 1)) more of $kind/ up to frame $4" ;;
    esac
  done
}

# Checks all data of the suite `semantickitti`. Exit code 2 if any is missing.
check_semantickitti() {
  local root=$1 found missing=0 segment
  # The segments of the ERASOR protocol, ends included.
  for segment in "00 4390 4530 2" "01 150 250 1" "02 860 950 2" "05 2350 2670 2" "07 630 820 2"; do
    read -r sequence first last stride <<<"$segment"
    found=$(check_segment "$root" "$sequence" "$first" "$last" "$stride")
    if [[ -z $found ]]; then
      echo "reproduce.sh: sequence $sequence, frames $first:$last:$stride: all there"
    else
      missing=1
      sed 's/^/reproduce.sh: missing: /' <<<"$found" >&2
    fi
  done
  [[ $missing -eq 0 ]] && return
  cat >&2 <<'END'
reproduce.sh: SemanticKITTI comes in three downloads, all unpacked to one folder so that
ROOT/sequences/00/ holds velodyne/, labels/, poses.txt and calib.txt:
  velodyne/  "KITTI Odometry Benchmark Velodyne point clouds" (80 GB), from the KITTI web site
  calib.txt  "KITTI Odometry Benchmark calibration data", from the KITTI web site
  labels/ and poses.txt  "SemanticKITTI label data", from the SemanticKITTI web site
END
  exit 2
}

what=()
quick=
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/reproduce.sh; exit 0 ;;
esac
if [[ ${1:-} == semantickitti ]]; then
  if [[ -z ${2:-} ]]; then
    echo "reproduce.sh: say where the data is: scripts/reproduce.sh semantickitti ROOT" >&2
    exit 2
  fi
  root=$(from_caller "$2")
  check_semantickitti "$root"
  [[ ${3:-} == --check ]] && exit
  data="SemanticKITTI in $root"
  label=semantickitti
  what=(semantickitti --data "$root")
elif [[ ${1:-} == --quick && $# -eq 1 ]]; then
  quick=1
  data="a short scene"
  label=quick
  # One scene of 60 scans, and of each method the variant that does best.
  what=(--sequence town:scans=60)
  for method in raymoval_plus:offline peopleremover:normals octomap:ground raymoval:offline \
    dufomap:offline erasor:version2 removert:rm3; do
    what+=(--method "$method")
  done
elif [[ $# -gt 0 ]]; then
  [[ $1 != --quick ]] || shift
  echo "reproduce.sh: '$1' is unknown; expected nothing, --quick, or semantickitti ROOT." >&2
  exit 2
fi

scripts/install_dependencies.sh
cmake --preset release ${RAYMOVAL_PCL:+-DRAYMOVAL_PCL="$RAYMOVAL_PCL"}
cmake --build --preset release --target raymoval_program
if [[ -n $quick ]] && grep -q 'octomap:ground .*PCL, which this build lacks' <<<"$(build/release/raymoval list variants)"; then
  echo "reproduce.sh: this build has no PCL, so octomap:kth runs in place of octomap:ground."
  what=("${what[@]/#octomap:ground/octomap:kth}")
fi

if [[ ${#what[@]} -gt 0 ]]; then
  :
elif [[ -n ${RAYMOVAL_DATA:-} ]]; then
  data=$RAYMOVAL_DATA
  # Names of built-in scenes are not paths.
  scene=${data%%:*}
  if [[ $scene != street ]] && ! grep -q "^$scene " <<<"$(build/release/raymoval list scenes)"; then
    data=$(from_caller "$data")
  fi
  label=$(basename "$data" | tr -c 'A-Za-z0-9._\n-' '_')
  what=(--sequence "$data" --method raymoval:online --method raymoval:offline)
else
  data="the suite simulated"
  label=simulated
  what=(simulated)
fi
out=results/run-$label
[[ -z ${RAYMOVAL_OUT:-} ]] || out=$(from_caller "$RAYMOVAL_OUT")

echo "reproduce.sh: running on $data, results go to $out"
# As many cells at once as there are cores, with 2 GiB of memory for each.
cores=$(nproc)
memory_gib=$(awk '/^MemTotal:/ { print int($2 / 1048576) }' /proc/meminfo)
jobs=$((memory_gib / 2 < cores ? memory_gib / 2 : cores))
[[ $jobs -ge 1 && $label != semantickitti ]] || jobs=1
what+=(--jobs "${RAYMOVAL_JOBS:-$jobs}")
# --overwrite: the folder is for this result only. Cells that are still valid are kept.
if [[ -n $quick ]]; then
  build/release/raymoval run "${what[@]}" --keep-removals --overwrite --out "$out"
  build/release/raymoval report "$out" --quiet
  echo "reproduce.sh: open $(readlink -f "$out")/report.html in a browser: tables, charts, and the points in 3-D."
  exit
fi
if [[ $label != semantickitti ]]; then
  exec build/release/raymoval run "${what[@]}" --overwrite --out "$out"
fi
status=0
build/release/raymoval run "${what[@]}" --overwrite --out "$out" >/dev/null || status=$?
# Table 2 with the paper's own rows beside ours; Table 3 are the stage times at its end.
[[ ! -e $out/results.json ]] || build/release/raymoval table "$out" --with-published
exit $status
