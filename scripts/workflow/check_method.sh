#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds a method, runs it, and compares its scores with a reference: what action.yml and
# examples/ci/gitlab.yml call in a CI server. Settings are variables of the environment.
#
#   METHOD=external:my_method/manifest.json scripts/workflow/check_method.sh
#
#   METHOD      what `raymoval run --method` takes; several by spaces
#   BUILD       shell commands that build the method (default: none)
#   PROGRAM     the program (default: raymoval)
#   SEQUENCE    a sequence or a scene (default: street)
#   OPTIONS     more options of `raymoval run`
#   REFERENCE   folder of the reference (default: .raymoval-reference)
#   COMPARE     options of `raymoval compare` (default: --across parameters,version)
#   OUT         folder for the run, compare.md and compare.xml (default: raymoval-out)
#   KEEP        yes: a better run becomes the reference, if none of its rates is worse, even within
#               the tolerance of COMPARE (else the reference could get worse step by step)
#
# Without a reference the run becomes it. The exit code is that of `raymoval compare`: 0 the same or
# better, 1 worse, 2 not comparable.
set -euo pipefail
case ${1:-} in
  "") ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
  *) echo "check_method.sh: '$1' is unknown; expected nothing." >&2; exit 2 ;;
esac
[[ -n ${METHOD:-} ]] || { echo "check_method.sh: METHOD is empty; expected what \`raymoval run --method\` takes." >&2; exit 2; }
program=${PROGRAM:-raymoval}
reference=${REFERENCE:-.raymoval-reference}
out=${OUT:-raymoval-out}
read -ra options <<<"${OPTIONS:-}"
read -ra compare <<<"${COMPARE:---across parameters,version}"

[[ -z ${BUILD:-} ]] || bash -euo pipefail -c "$BUILD"
for method in $METHOD; do options+=(--method "$method"); done
"$program" run --sequence "${SEQUENCE:-street}" "${options[@]}" --overwrite --out "$out/run"
if [[ ! -e $reference/results.json ]]; then
  echo "There is no reference yet; this run becomes it." | tee "$out/compare.md"
  "$program" table "$out/run" >>"$out/compare.md"
  "$program" compare "$out/run" "$reference" --update
  exit 0
fi
status=0
"$program" compare "$out/run" "$reference" "${compare[@]}" --format junit --overwrite -o "$out/compare.xml" || status=$?
"$program" compare "$out/run" "$reference" "${compare[@]}" --format md --overwrite -o "$out/compare.md" >/dev/null || true
if [[ $status -eq 0 && ${KEEP:-} == yes ]] &&
  "$program" compare "$out/run" "$reference" --across parameters,version >/dev/null 2>&1; then
  "$program" compare "$out/run" "$reference" --update
fi
exit "$status"
