#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Detects races, and answers that depend on the number of threads. CI does not run it: it takes half
# an hour on two cores.
#
#   scripts/threads.sh                       both of the following, masks on the scene `town`
#   scripts/threads.sh races [REGEX]         ThreadSanitizer (build/tsan): the unit tests of loops, child
#                                            processes and runs (or those whose names match), every
#                                            method, and whole commands
#   scripts/threads.sh masks [SEQUENCE [FIRST:LAST [METHOD...]]]
#                                            masks and reasons of every variant of every method, and of
#                                            every switch, with 1, 2, 3 and 8 threads (build/release)
#
# The exit code is 1 if a race or a difference was found.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1

# Reports a failure and continues.
status=0
failed() {
  echo "threads.sh: $1" >&2
  status=1
}

# sanitized COMMAND...: without address space randomisation, which ThreadSanitizer does not support.
# Reports go to files, because the output of child processes is not always shown.
suppressions=$PWD/tests/threads/libraries.supp
reports=$PWD/build/tsan/races
sanitized() {
  TSAN_OPTIONS="suppressions=$suppressions:log_path=$reports/in" setarch -R "$@"
}

# commands: what runs in parallel outside of methods: reading, simulation, scoring, cells in
# processes of their own, inspection, cleaning, reports.
commands() {
  local work program=$PWD/build/tsan/raymoval
  local methods=(--method raymoval --method raymoval_plus:online --method dufomap --threads 4)
  local protocols=(--protocol erasor --protocol dynamicmap --protocol dynamicmap-strict)
  work=$(mktemp -d) || return 1
  (
    cd "$work" && export RAYMOVAL_CACHE=$work/cache &&
      sanitized "$program" simulate town --scans 6 --sensor vlp16 -o town --threads 4 --quiet &&
      sanitized "$program" run --sequence street --frames 0:9 "${methods[@]}" "${protocols[@]}" \
        --keep-removals --out run --quiet &&
      sanitized "$program" run --sequence street --frames 0:9 --method noop "${methods[@]:0:6}" \
        "${protocols[@]}" --jobs 3 --out jobs --quiet &&
      sanitized "$program" run --sequence ./town "${methods[@]}" "${protocols[@]}" --in-process \
        --out run2 --quiet &&
      # 1: it found something.
      { sanitized "$program" inspect ./town --threads 4 || [[ $? -eq 1 ]]; } &&
      sanitized "$program" clean ./town -o map.pcd --labels labels --method raymoval --threads 4 \
        --force --quiet &&
      sanitized "$program" report run -o report.html --quiet
  ) >build/tsan/commands.log 2>&1
  local result=$?
  rm -rf "$work"
  return "$result"
}

# watches: whether a race is found where there is one, and none where there is none.
watches() {
  TSAN_OPTIONS="" setarch -R build/tsan/raymoval_planted_race none >/dev/null 2>&1 &&
    ! TSAN_OPTIONS="" setarch -R build/tsan/raymoval_planted_race between-chunks >/dev/null 2>&1
}

# Names of the unit tests of parallel code.
in_parallel='[Tt]hread|Chunks|index is visited|lowest chunk|: a child|: all that a forking'
in_parallel+='|foreseen|at once|[Jj]obs|more passes|maps added up'
in_parallel+='|: external|[Rr]uns? (give|is|are|has|that)|cancelled|progress'

races() {
  cmake --preset tsan >/dev/null &&
    cmake --build --preset tsan &&
    cmake --build --preset tsan --target raymoval_threads raymoval_planted_race || exit 2
  watches || failed "ThreadSanitizer does not tell a race from none here."
  rm -rf "$reports"
  mkdir -p "$reports"
  # raymoval_threads does what is left out here, with more threads and data.
  sanitized ctest --preset tsan --no-tests=error -R "${1:-$in_parallel}" \
    -E 'methods:any number of threads' || failed "unit tests: a failure or a race, see above."
  sanitized build/tsan/raymoval_threads street 0:5 | tee build/tsan/methods.log
  [[ ${PIPESTATUS[0]} -eq 0 ]] || failed "methods: a race or a difference, see above."
  commands || failed "commands: a failure or a race, see build/tsan/commands.log."
  [[ -z $(ls "$reports") ]] || failed "$(ls "$reports" | wc -l) processes with races, see $reports."
}

masks() {
  cmake --preset release >/dev/null &&
    cmake --build --preset release --target raymoval_threads || exit 2
  [[ $# -gt 0 ]] || set -- town 0:19
  build/release/raymoval_threads "$@" || failed "an answer depends on the number of threads."
}

case ${1:-} in
  "") races; masks ;;
  races) races "${@:2}" ;;
  masks) masks "${@:2}" ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/threads.sh ;;
  *) echo "threads.sh: '$1' is unknown; expected races, masks or nothing." >&2; exit 2 ;;
esac
exit "$status"
