#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fuzzes every parser with clang's libFuzzer (Debian: clang), one after another.
#
#   scripts/fuzz.sh [SECONDS [TARGET...]]     default: 600 seconds each, all targets
#
# New inputs go to build/fuzz/found/TARGET. Inputs that break a parser go to build/fuzz/findings/TARGET,
# and then the exit code is 1. Put a finding into tests/fuzz/corpus/TARGET under a descriptive name:
# then ctest replays it.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/fuzz.sh; exit 0 ;;
esac
seconds=${1:-600}
[[ $# -gt 0 ]] && shift
if ! [[ $seconds =~ ^[1-9][0-9]*$ ]]; then
  echo "fuzz.sh: '$seconds' is no number of seconds." >&2
  exit 2
fi
if ! command -v clang++ >/dev/null; then
  echo "fuzz.sh: clang++ is missing; install it with: apt-get install clang" >&2
  exit 2
fi
targets=("$@")
cmake --preset fuzz >/dev/null || exit 2
programs=("${targets[@]/#/fuzz_}")
[[ ${#targets[@]} -gt 0 ]] || programs=(fuzzers)
cmake --build --preset fuzz --target "${programs[@]}" || exit 2
if [[ ${#targets[@]} -eq 0 ]]; then
  for program in build/fuzz/fuzz_*; do targets+=("${program#build/fuzz/fuzz_}"); done
fi
status=0
for target in "${targets[@]}"; do
  mkdir -p "build/fuzz/found/$target" "build/fuzz/findings/$target"
  log=build/fuzz/found/$target.log
  # No input is larger than 4 KiB: more than 256 MiB at once, or 10 seconds, is out of proportion.
  if build/fuzz/fuzz_"$target" -max_total_time="$seconds" -max_len=4096 -timeout=10 \
      -malloc_limit_mb=256 -rss_limit_mb=1024 -print_final_stats=1 \
      -artifact_prefix="build/fuzz/findings/$target/" \
      "build/fuzz/found/$target" "tests/fuzz/corpus/$target" >"$log" 2>&1; then
    runs=$(sed -nE 's/^stat::number_of_executed_units: *//p' "$log")
    echo "$target: no finding in $seconds s and $runs inputs"
  else
    echo "$target: a finding, see $log"
    status=1
  fi
done
exit $status
