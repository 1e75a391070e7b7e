#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Times the kernels of the raymoval method and the usual way to cast rays, in one process.
#
#   scripts/benchmark.sh [--out DIR]                 results go to DIR (default: results/run-kernels)
#   RAYMOVAL_DATA=DIR scripts/benchmark.sh           also on your own sequence, see
#                                                    `raymoval list sequences`
#
# Writes kernels.json (repetitions in random order), and prints its table.
# `raymoval run` measures whole methods and their stages.
set -euo pipefail
caller=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
  echo "benchmark.sh: $1" >&2
  exit 2
}

# Relative paths start at the caller's folder.
from_caller() {
  if [[ $1 == /* ]]; then echo "$1"; else echo "$caller/$1"; fi
}

out=results/run-kernels
while [[ $# -gt 0 ]]; do
  case $1 in
    --out)
      [[ $# -ge 2 && -n $2 ]] || fail "--out needs a folder: scripts/benchmark.sh --out DIR"
      out=$(from_caller "$2")
      shift 2
      ;;
    -h | --help)
      sed -n '3,10s/^# \{0,1\}//p' scripts/benchmark.sh
      exit 0
      ;;
    *) fail "unknown argument '$1'; usage: scripts/benchmark.sh [--out DIR]" ;;
  esac
done

if [[ -n ${RAYMOVAL_DATA:-} ]]; then
  if [[ -e $(from_caller "${RAYMOVAL_DATA%%:*}") ]]; then
    RAYMOVAL_DATA=$(from_caller "$RAYMOVAL_DATA")
    export RAYMOVAL_DATA
  fi
else
  echo "benchmark.sh: RAYMOVAL_DATA is not set: only the simulated sequence is used."
fi
mkdir -p "$out" || fail "cannot make the folder $out"

cmake --preset release -DRAYMOVAL_BUILD_KERNELS=ON >"$out/build.log" 2>&1 &&
  cmake --build --preset release --target raymoval_kernels >>"$out/build.log" 2>&1 ||
  fail "the build failed, see $out/build.log (scripts/install_dependencies.sh installs what is needed)"

kernels=build/release/raymoval_kernels
# A run that is stopped leaves no partial file.
rm -f "$out/kernels.json"
"$kernels" --benchmark_out="$out/kernels.part" --benchmark_out_format=json --benchmark_repetitions=5 \
  --benchmark_min_time=0.1 --benchmark_enable_random_interleaving=true ||
  fail "the run for kernels.json failed, see above"
# Google Benchmark writes undefined aggregates as NaN, which is no JSON.
sed -E 's/: -?(NaN|nan|inf|Infinity)(,?)$/: null\2/' "$out/kernels.part" >"$out/kernels.json"
rm "$out/kernels.part"
echo "benchmark.sh: wrote $out/kernels.json"
