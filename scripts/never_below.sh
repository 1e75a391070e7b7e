#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Lists where any method of the suite beats raymoval_plus:offline by more than 0.005 F1 or one point of AA: every world
# of the suites `simulated` and `simulated-hard`, with its own sensor and two others, by every family of methods.
# It takes hours, and is no test; a second call goes on where it was stopped.
#
#   scripts/never_below.sh                      # 60 scans of seed 303
#   SEED=305 SCANS=100 scripts/never_below.sh
#   METHODS="freedom:few-counts mapcleaner:sound" SENSORS="vlp16" scripts/never_below.sh
#
# Choose on odd seeds; an even one is for a report, and is then counted as looked at.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case ${1:-} in
  "") ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/never_below.sh; exit 0 ;;
  *) echo "never_below.sh: '$1' is unknown; expected nothing." >&2; exit 2 ;;
esac
seed=${SEED:-303}
scans=${SCANS:-60}
read -ra sensors <<<"${SENSORS:-vlp16 solid-state}"
read -ra methods <<<"${METHODS:-raymoval:offline octomap:ground peopleremover:normals removert:rm3 erasor:general \
  erasor:auto dufomap:offline beautymap:wide freedom:few-counts hmm_mos:offline dynablox:offline-wide mapcleaner:sound}"
worlds=(town highway country suburb crossing excavator
  junction market walk carpark motorway mountain warehouse rain glass revisit)
out=out/never_below/$seed-$scans

cmake --preset release
cmake --build --preset release --target raymoval_program
mkdir -p "$out"
{
  echo '{ "name": "never-below", "protocols": ["erasor", "dynamicmap"], "sequences": ['
  separator=
  for world in "${worlds[@]}"; do
    for sensor in "" "${sensors[@]}"; do
      echo "$separator{\"path\": \"$world:seed=$seed,scans=$scans${sensor:+,sensor=$sensor}\", \"name\": \"$world${sensor:+-$sensor}\"}"
      separator=,
    done
  done
  echo '], "methods": ["raymoval_plus:offline"'
  printf ', "%s"' "${methods[@]}"
  echo '] }'
} >"$out/suite.json"
build/release/raymoval run "$out/suite.json" --out "$out/run" --jobs "${JOBS:-$(nproc)}"
python3 -B scripts/never_below.py "$out/run/results.csv"
