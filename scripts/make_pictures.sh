#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of README.md anew, from simulated scenes, into results/pictures/.
#
#   scripts/make_pictures.sh            # builds what is missing, runs, draws: a few minutes
#   scripts/make_pictures.sh RUN        # draws an earlier run of this script again
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

"$raymoval" picture "$run" -o $pictures/maps.png --size 300
"$raymoval" picture "$run" -o $pictures/overview.png --kind overview --sequence town \
  --method raymoval_plus:offline --size 620
"$raymoval" picture "$run" -o $pictures/range_images.png --kind range --sequence town \
  --method raymoval_plus:offline --scan 40 --size 900

for picture in maps overview range_images; do
  bytes=$(stat -c %s "$pictures/$picture.png")
  echo "$pictures/$picture.png: $bytes bytes"
  if ((bytes > 300000)); then
    echo "make_pictures.sh: $picture.png is larger than 300 kB; choose a smaller --size." >&2
    exit 1
  fi
done
