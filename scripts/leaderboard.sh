#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes docs/leaderboard.md anew: runs the methods of the suite `quick`, scores their masks and those
# of all submissions again, and ranks what holds by paired intervals. The example's masks are made
# here. A submission that does not hold ends it.
#
#   scripts/leaderboard.sh [--masks DIR]   DIR has a folder with the masks of each other submission, by its name
set -euo pipefail
caller=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
  echo "leaderboard.sh: $1" >&2
  exit 2
}
given=
case ${1:-} in
  "") ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/leaderboard.sh; exit 0 ;;
  --masks)
    [[ $# -eq 2 ]] || fail "--masks needs a folder: scripts/leaderboard.sh --masks DIR"
    given=$(cd "$caller" && cd "$2" 2>/dev/null && pwd) || fail "--masks $2: no such folder"
    ;;
  *) fail "'$1' is unknown; expected --masks DIR or nothing." ;;
esac

program=build/release/raymoval
[[ -x $program ]] || fail "$program is missing; build it (cmake --preset release && cmake --build --preset release)"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/masks"
[[ -z $given ]] || ln -s "$given"/* "$work/masks/"
"$program" run quick --keep-removals --quiet --out "$work/quick" >"$work/log.txt"
RAYMOVAL_PYTHON=${RAYMOVAL_PYTHON:-/usr/bin/python3} "$program" run --sequence street --quiet \
  --method external:examples/external/voxel_counts/manifest.json --keep-removals --out "$work/example" >"$work/log.txt"
mv "$work/example/cells/street/voxel-counts-default/removals" "$work/masks/voxel_counts"
"$program" verify "$work/quick" results/submissions/*/ --masks "$work/masks" --quiet --table "$work/table.md"
{
  sed '/^<!-- tables -->$/q' docs/leaderboard.md
  echo
  cat "$work/table.md"
} >"$work/page.md"
cp "$work/page.md" docs/leaderboard.md
echo "leaderboard.sh: wrote docs/leaderboard.md"
