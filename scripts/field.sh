#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes docs/field.md's numbers anew: every family of methods on simulated scenes, with other sensors, at
# lower rates, and in the hand (the suite `field`); about an hour and a half on two cores.
#
#   scripts/field.sh                 # runs the suite in out/field; a second call goes on where it was stopped
#   scripts/field.sh DRIVE           # also a drive of yours at three rates, points from 2.7 m to 50 m
#   JOBS=1 scripts/field.sh          # one cell at a time
#
# It writes results/field/*.csv, the tables of docs/field.md, and the pictures of that page.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/field.sh; exit 0 ;;
  -*) echo "field.sh: '$1' is unknown; expected nothing, or the folder of a drive." >&2; exit 2 ;;
esac
drive=${1:-}
# Said now, and not when the scenes have run for an hour.
if [[ -n $drive && ! -d $drive ]]; then
  echo "field.sh: there is no folder '$drive'; expected that of a labelled drive, such as data/05." >&2
  exit 2
fi
jobs=${JOBS:-$(nproc)}
out=out/field

cmake --preset release
cmake --build --preset release --target raymoval_program
raymoval=build/release/raymoval

# Times of cells that ran side by side are no measure, and memory is not this page's matter.
keep_rates() { cut -d, -f1-15,18 "$1"; }

mkdir -p results/field
"$raymoval" run field --out $out/scenes --jobs "$jobs"
keep_rates $out/scenes/results.csv >results/field/scenes.csv

if [[ -n $drive ]]; then
  # "name": a suite's sequences need one each, for they are the same folder.
  sed -n '/"methods"/,$p' benchmark/suites/field.json >$out/rest.json
  path=$(python3 -c 'import json, os, sys; print(json.dumps(os.path.abspath(sys.argv[1])))' "$drive")
  range='"range_m": { "min": 2.7, "max": 50 }'
  cat - $out/rest.json >$out/drive.json <<EOF
{
  "name": "field-drive",
  "sequences": [
    { "path": $path, "name": "drive", $range },
    { "path": $path, "name": "drive-5hz", "frames": "::2", $range },
    { "path": $path, "name": "drive-2hz", "frames": "::5", $range }
  ],
EOF
  "$raymoval" run $out/drive.json --out $out/drive --jobs "$jobs"
  keep_rates $out/drive/results.csv >results/field/drive.csv
fi
python3 -B scripts/field_page.py

# What some methods leave of three scenes.
pictures=("raymoval_plus:offline" "freedom:few-counts" "mapcleaner:sound" "peopleremover:normals" "erasor:general"
  "removert:rm3")
chosen=()
for method in "${pictures[@]}"; do chosen+=(--method "$method"); done
"$raymoval" run --sequence town:seed=304 --sequence highway:seed=304 --sequence walk:seed=304 "${chosen[@]}" \
  --keep-removals --jobs "$jobs" --out $out/pictures >/dev/null
"$raymoval" picture $out/pictures -o results/pictures/field_maps.png --size 300
