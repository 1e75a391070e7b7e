#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Recomputes the numbers of docs/field.md: every family of methods on simulated scenes, with other sensors, at
# lower rates, and hand-held (the suite `field`; about an hour and a half on two cores), on difficult worlds
# (`field-hard`, twice as many cells), and the gain of delayed answers (`field-delay`, a few minutes).
#
#   scripts/field.sh                 # runs the suite in out/field; a second call resumes it
#   scripts/field.sh DRIVE           # also a drive of yours at three rates, points from 2.7 m to 50 m
#   JOBS=1 scripts/field.sh          # one cell at a time
#   ONLY='*/raymoval_plus:*' scripts/field.sh DRIVE    # these cells again, such as after a change of a method
#
# It writes results/field/*.csv, results/delay/*.csv, the tables of docs/field.md, and the pictures of that page.
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

only=()
within=--take
if [[ -n ${ONLY:-} ]]; then
  only=(--only "$ONLY")
  within=--within
fi

# take NAME SUITE: runs a suite, and takes its rates into results/NAME.csv.
take() {
  if [[ $within == --within && ! -e results/$1.csv ]]; then
    echo "field.sh: results/$1.csv is not there, so there is nothing to put these cells into; suite $2 is left out."
    return
  fi
  "$raymoval" run "$2" --out "out/$1" --jobs "$jobs" "${only[@]}"
  python3 -B scripts/field_page.py "$within" "out/$1/results.csv" "results/$1.csv"
}

mkdir -p results/field results/delay $out
take field/scenes field
take field/hard field-hard
# The suite field-delay has one method, and a run of no cells is an error.
delay=
# shellcheck disable=SC2053  # ONLY is a pattern.
if [[ -z ${ONLY:-} || town/raymoval_plus:online-lag:delay=1 == $ONLY ]]; then
  delay=yes
  take delay/scenes field-delay
  "$raymoval" picture out/delay/scenes --kind sweep --overwrite -o results/pictures/delay.svg
fi

# drive_suite SUITE: the methods of a shipped suite, and the drive at three rates.
drive_suite() {
  # "name": a suite's sequences need one each, for they are the same folder.
  local path range='"range_m": { "min": 2.7, "max": 50 }'
  path=$(python3 -c 'import json, os, sys; print(json.dumps(os.path.abspath(sys.argv[1])))' "$drive")
  cat <<EOF
{
  "name": "$1-drive",
  "sequences": [
    { "path": $path, "name": "drive", $range },
    { "path": $path, "name": "drive-5hz", "frames": "::2", $range },
    { "path": $path, "name": "drive-2hz", "frames": "::5", $range }
  ],
EOF
  sed -n '/"methods"/,$p' "benchmark/suites/$1.json"
}

if [[ -n $drive ]]; then
  drive_suite field >$out/drive.json
  take field/drive $out/drive.json
  if [[ -n $delay ]]; then
    drive_suite field-delay >$out/delay_drive.json
    take delay/drive $out/delay_drive.json
  fi
fi
python3 -B scripts/field_page.py

# What some methods leave of three scenes.
pictures=("raymoval_plus:offline" "freedom:few-counts" "mapcleaner:sound" "peopleremover:normals" "erasor:general"
  "removert:rm3")
chosen=()
for method in "${pictures[@]}"; do chosen+=(--method "$method"); done
"$raymoval" run --sequence town:seed=304 --sequence highway:seed=304 --sequence walk:seed=304 "${chosen[@]}" \
  --keep-removals --jobs "$jobs" --out $out/pictures >/dev/null
"$raymoval" picture $out/pictures --overwrite -o results/pictures/field_maps.png --size 300
