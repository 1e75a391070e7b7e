#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs test cases in one process, which under sanitizers costs much less than one for each. If that
# fails, each case is run alone, so that what is printed ends with the names of those that fail.
# Usage: run_cases.sh TEST_PROGRAM FILE [OPTION...]. The file chooses one case in each line.
set -uo pipefail
program=$1
mapfile -t cases <"$2"
options=("${@:3}")
"$program" "$(IFS=,; echo "${cases[*]}")" ${options[@]+"${options[@]}"} && exit 0
status=$?
echo "== one process for ${#cases[@]} cases failed (exit code $status); each of them alone:"
alone=()
for case in "${cases[@]}"; do
  "$program" "$case" ${options[@]+"${options[@]}"} >/dev/null 2>&1 || alone+=("$case")
done
[[ ${#alone[@]} -gt 0 ]] || echo "FAILED: none alone, but all together"
for case in ${alone[@]+"${alone[@]}"}; do
  "$program" "$case" ${options[@]+"${options[@]}"} 2>&1 | tail -n 25
  echo "FAILED: ${case//\\/}"
done
exit 1
