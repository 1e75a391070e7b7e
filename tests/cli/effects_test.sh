#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What the program says of parameters that have no effect, and of sweeps that make no difference.
# Usage: effects_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
short=(--sequence street --frames 0:2 --quiet)
naive=raymoval:offline-naive
when="it acts when forward_test is true and map_source is not naive"

# silent COMMAND...: done, without a warning.
silent() {
  expect 0 "" "$@"
  holds "raymoval $* warns of nothing" test -z "$(grep warning err.txt)"
}

# describe marks them in the variant that is described, and gives conditions otherwise.
expect 0 "NO EFFECT in this variant: $when." describe $naive
expect 0 "It acts when forward_test is true" describe raymoval
holds "raymoval:offline has eq. 11" test -z "$("$raymoval" describe raymoval:offline | grep -A1 '^  tau[01] ' | grep 'NO EFFECT')"
expect 0 '"acts": false' describe $naive --json
expect 0 "NO EFFECT in this variant: $when." describe $naive --markdown
expect 0 "It changes time or memory only." describe octomap

# --set warns in run, plan and clean, once for each variant without effect.
warning="raymoval: warning: $naive.tau1 has no effect here: $when."
expect 0 "$warning" run "${short[@]}" --method $naive --set raymoval.tau1=0.2 --out naive
expect 0 "$warning" run "${short[@]}" --method $naive --method raymoval:offline \
  --set raymoval.tau1=0.2 --explain --out o
"$raymoval" plan --sequence street --frames 0:2 --method $naive --method raymoval:offline \
  --set raymoval.tau1=0.2 >out.txt 2>plan.txt
holds "plan warns of one variant of two" test "$(grep -c warning plan.txt)" -eq 1
expect 0 "$warning" clean street --frames 0:2 --quiet --method $naive --set raymoval.tau1=0.2 -o map.pcd
silent plan "${short[@]}" --method raymoval:offline --set raymoval.tau1=0.2
silent plan "${short[@]}" --method $naive --set raymoval.erase_tau1=0.2
silent plan "${short[@]}" --method $naive

# A sweep without effect is told before it runs, and in its table after.
cat >sweep.json <<'END'
{"sequences": [{"path": "street", "frames": "0:4"}], "controls": false, "methods": [
  {"method": "raymoval:offline-naive", "set": {"tau1": {"sweep": [0, 0.35]}}}]}
END
flat="tau1 made no difference: with each of its 2 values exactly the same points were removed."
expect 0 "$warning" run sweep.json --quiet --out sweep
expect 0 "raymoval: warning: sweep of $naive over tau1: $flat" run sweep.json --quiet --out sweep
expect 0 "$flat" table sweep

finish effects
