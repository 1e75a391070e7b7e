#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Every script says what it is for, from any folder, and refuses what it does not know before it
# does anything.
set -uo pipefail
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

# tells CODE TEXT SCRIPT ARGUMENTS...: the exit code, and TEXT somewhere in what was printed.
tells() {
  checks=$((checks + 1))
  timeout 20 "$3" "${@:4}" >out.txt 2>err.txt
  local got=$?
  [[ $got -eq $1 ]] && cat out.txt err.txt | grep -qF -- "$2" ||
    complain "${*:3}: exit code $got, expected $1 and '$2'"
}

ln -s "$scripts" scripts
for script in scripts/*.sh scripts/workflow/test_slurm.sh; do
  tells 0 "$script" "$script" --help
  holds "$script --help is its head only" test -z "$(grep -e '^set ' -e '^#' <("$script" --help))"
  tells 2 "--nonsense" "$script" --nonsense
done
finish scripts
