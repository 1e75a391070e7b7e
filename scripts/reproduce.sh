#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# From a fresh clone to a comparison table: installs, builds, runs, prints.
#
#   scripts/reproduce.sh                             the suite `simulated`: six simulated scenes
#   RAYMOVAL_DATA=/data/kitti:kitti-05 scripts/reproduce.sh    your own sequence, see
#                                                    `raymoval list sequences`
#   RAYMOVAL_OUT=DIR                                 where results go (default: results/run-...)
set -euo pipefail
caller=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install_dependencies.sh
cmake --preset release
cmake --build --preset release --target raymoval_program

# Paths are meant from where the script was called.
from_caller() {
  if [[ $1 == /* ]]; then echo "$1"; else echo "$caller/$1"; fi
}
if [[ -n ${RAYMOVAL_DATA:-} ]]; then
  data=$RAYMOVAL_DATA
  # Names of built-in scenes stay as they are.
  scene=${data%%:*}
  if [[ $scene != street ]] && ! build/release/raymoval list scenes | grep -q "^$scene "; then
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
build/release/raymoval run "${what[@]}" --out "$out"
