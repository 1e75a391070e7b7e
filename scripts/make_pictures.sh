#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of README.md, docs/ and methods/raymoval_plus/ from simulated scenes, in
# results/pictures/.
#
#   scripts/make_pictures.sh            # builds what is missing, runs, draws: a few minutes
#   scripts/make_pictures.sh RUN        # draws the earlier runs RUN and RUN-plus again
#
# The same program, fonts and libraries give the same bytes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/make_pictures.sh; exit 0 ;;
  -*) echo "make_pictures.sh: '$1' is unknown; expected nothing, or the folder RUN." >&2; exit 2 ;;
esac

raymoval=build/release/raymoval
if [[ ! -x $raymoval ]]; then
  cmake --preset release && cmake --build build/release --target raymoval_program
fi

pictures=results/pictures
run=${1:-out/pictures}
"$raymoval" run --sequence town:scans=60 --sequence crossing:scans=60 \
  --method raymoval_plus:offline --method raymoval:offline --method octomap:ground \
  --method removert:rm3 --keep-removals --out "$run" >/dev/null

"$raymoval" picture "$run" --overwrite -o $pictures/maps.png --size 300
"$raymoval" picture "$run" --overwrite -o $pictures/before_after.png --size 420 --crop 10:100:-20:20 \
  --only 'town/noop*' --only 'town/raymoval_plus*'

# The steps of raymoval_plus.
mkdir -p "$run-plus"
cat >"$run-plus.json" <<'EOF'
{
  "sequences": ["suburb"],
  "methods": [
    {"method": "raymoval_plus:offline", "as": "evidence",
     "set": {"vote_radius": 0, "objects": false, "tracks": false, "low_points": false}},
    {"method": "raymoval_plus:offline", "as": "with-vote",
     "set": {"objects": false, "tracks": false, "low_points": false}},
    {"method": "raymoval_plus:offline", "as": "all-steps"}
  ],
  "protocols": ["erasor"]
}
EOF
"$raymoval" run "$run-plus.json" --keep-removals --out "$run-plus" >/dev/null
"$raymoval" picture "$run-plus" --overwrite -o $pictures/plus_steps.png --only 'suburb/evidence*' \
  --only 'suburb/with-vote*' --only 'suburb/all-steps*' \
  --crop 10:58:-14:14 --resolution 0.1

for picture in maps before_after plus_steps; do
  bytes=$(stat -c %s "$pictures/$picture.png")
  echo "$pictures/$picture.png: $bytes bytes"
  if ((bytes > 300000)); then
    echo "make_pictures.sh: $picture.png is larger than 300 kB; choose a smaller --size." >&2
    exit 1
  fi
done
