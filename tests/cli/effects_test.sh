#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What the program says of parameters that have no effect, and of sweeps that make no difference.
# Usage: effects_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
short=(--sequence street --frames 0:2 --quiet)
general=erasor:general
when="it acts when version is 2"

# silent COMMAND...: done, without a warning.
silent() {
  expect 0 "" "$@"
  holds "raymoval $* warns of nothing" test -z "$(grep warning err.txt)"
}

# describe marks them in the variant that is described, and gives conditions otherwise.
expect 0 "NO EFFECT in this variant: $when." describe $general
expect 0 "It acts when version is 2" describe erasor
holds "th_bin_max_h acts in erasor:version2" test -z "$("$raymoval" describe erasor:version2 | grep -A1 '^  th_bin_max_h ' | grep 'NO EFFECT')"
expect 0 "NO EFFECT in this variant: $when." describe $general --markdown

# --set warns in run, plan and clean, once for each variant without effect.
warning="raymoval: warning: $general.th_bin_max_h has no effect here: $when."
set=(--set erasor.th_bin_max_h=0.3)
expect 0 "$warning" run "${short[@]}" --method $general "${set[@]}" --out general
expect 0 "$warning" run "${short[@]}" --method $general --method erasor:version2 "${set[@]}" --explain --out o
"$raymoval" plan --sequence street --frames 0:2 --method $general --method erasor:version2 "${set[@]}" >out.txt 2>plan.txt
holds "plan warns of one variant of two" test "$(grep -c warning plan.txt)" -eq 1
expect 0 "$warning" clean street --frames 0:2 --quiet --method $general "${set[@]}" -o map.pcd
silent plan "${short[@]}" --method erasor:version2 "${set[@]}"
silent plan "${short[@]}" --method $general --set erasor.scan_ratio_threshold=0.3
silent plan "${short[@]}" --method $general

# A sweep without effect is reported before it runs.
cat >sweep.json <<'END'
{"sequences": [{"path": "street", "frames": "0:4"}], "controls": false, "methods": [
  {"method": "erasor:general", "set": {"th_bin_max_h": {"sweep": [0, 0.3]}}}]}
END
expect 0 "$warning" run sweep.json --quiet --out sweep

finish effects
