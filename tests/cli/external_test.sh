#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the example of a method in Python as a user would. Usage: external_test.sh RAYMOVAL EXAMPLES
set -uo pipefail
raymoval=$(readlink -f "$1")
examples=$(readlink -f "$2")

# The first interpreter that has numpy.
for python in "${RAYMOVAL_PYTHON:-}" python3 /usr/bin/python3; do
  [[ -n $python ]] && "$python" -c 'import numpy' 2>/dev/null && break
  python=
done
if [[ -z $python ]]; then
  echo "SKIPPED: no Python with numpy. Install python3-numpy, or set RAYMOVAL_PYTHON." >&2
  exit 77
fi
export RAYMOVAL_PYTHON=$python

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
mkdir temporary
export TMPDIR=$work/temporary
failures=0
# holds NAME COMMAND...
holds() {
  "${@:2}" >out.txt 2>err.txt && return
  failures=$((failures + 1))
  echo "FAILED: $1"
  sed 's/^/  /' out.txt err.txt | head -20
}

cp -r "$examples/external/voxel_counts" method
method=external:method/manifest.json
run=("$raymoval" run --sequence street --quiet --method "$method")
short=("${run[@]}" --frames 0:9)
column() { awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i }
                                 $2 == "voxel-counts" { print $c }' out/results.csv; }
value() { sed -n "s/.*\"$1\": \"\\(.*\\)\".*/\\1/p" "$2" | head -1; }
cell=cells/street/voxel-counts-default/cell.json

holds "the example runs" "${run[@]}" --out out --keep-removals
holds "it keeps what stands" awk -v x="$(column PR)" 'BEGIN { exit !(x > 85) }'
holds "it removes what moves" awk -v x="$(column RR)" 'BEGIN { exit !(x > 80) }'
rm -r out/cells/street/voxel-counts-default/removals
holds "it leaves no file behind" test -z "$(ls temporary)"
holds "a short run" "${short[@]}" --out out --overwrite
holds "runs again" "${short[@]}" --out again
holds "with the same answer" test "$(value digest out/$cell)" = "$(value digest again/$cell)"
holds "and the same key" test "$(value key out/$cell)" = "$(value key again/$cell)"
holds "no path is in the result" test -z "$(grep -F "$work" out/$cell)"

holds "a parameter is set" "${short[@]}" --set voxel-counts.minimum_through=1000 --out none
holds "and has its effect" grep -q '"removed": 0' none/${cell/default/default_}
cat >suite.json <<'SUITE'
{ "sequences": [{ "path": "street", "frames": "0:5" }], "controls": false,
  "methods": [{ "method": "external:manifest.json", "set": { "voxel_size": 0.3 }, "as": "mine" }] }
SUITE
mv suite.json method/
holds "a suite names a manifest beside it" "$raymoval" run method/suite.json --quiet --out suite
holds "by the name it gives" test -s suite/cells/street/mine/cell.json
"$raymoval" describe "$method" >description.txt
holds "describe tells its parameters" grep -qF "Edge of a voxel." description.txt
holds "a map is cleaned with it" "$raymoval" clean street --frames 0:5 --method "$method" --quiet \
  -o map.pcd

echo "# changed" >>method/voxel_counts.py
holds "a changed program runs again" "${short[@]}" --out again
holds "as its key is another" test "$(value key out/$cell)" != "$(value key again/$cell)"
echo 'raise SystemExit("no more")' >method/voxel_counts.py
"${short[@]}" --out failed >out.txt 2>err.txt
holds "a failed program fails the run" test $? -eq 1
grep -h 'exit code 1' failed/$cell >reason.txt
holds "with what it printed" grep -q 'no more' reason.txt
echo 'import time; time.sleep(600)' >method/voxel_counts.py
"${short[@]}" --time-limit 1 --only '*/voxel*' --out late >out.txt 2>err.txt
holds "a program that hangs is ended" grep -q '"status": "timeout"' late/$cell
holds "nothing is left" test -z "$(ls temporary)"

[[ $failures -eq 0 ]] && echo "external: all checks hold"
[[ $failures -eq 0 ]]
