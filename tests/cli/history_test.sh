#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# scripts/record.sh with a program that only says what it is told, in a repository of its own, and
# what `raymoval history` makes of it. Usage: history_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source_folder=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../..")
source "$source_folder/tests/cli/checks.sh"

# tells CODE TEXT COMMAND...: the exit code, and TEXT somewhere in what was printed.
tells() {
  checks=$((checks + 1))
  "${@:3}" >out.txt 2>err.txt
  local got=$?
  [[ $got -eq $1 ]] && grep -qF -- "$2" out.txt err.txt || complain "${*:3}: exit code $got, expected $1 and '$2'"
}

if ! command -v git >/dev/null; then
  echo "history_test.sh: git is needed." >&2
  exit 1
fi
mkdir -p house/scripts house/benchmark/suites house/results/reference/street
cp "$source_folder"/scripts/record.{sh,py} house/scripts/
cp "$source_folder"/benchmark/suites/{quick,simulated-quick}.json house/benchmark/suites/
echo 'project(raymoval VERSION 0.7.0 LANGUAGES CXX)' >house/CMakeLists.txt
cp "$source_folder/results/reference/street/results.json" house/results/reference/street/
git=(git -C house -c user.name=n -c user.email=e@example.org)
"${git[@]}" init -q
"${git[@]}" add .
"${git[@]}" commit -qm one
first=$("${git[@]}" rev-parse HEAD)

# It knows one method, and has $kept of 100 voxels kept on the street.
cat >program <<'PROGRAM'
#!/usr/bin/env python3
import json, os, sys
words = sys.argv[1:]
if words == ["--version"]:
    print("raymoval 0.7.0")
elif words[0] == "describe":
    sys.exit(0 if words[1] == "raymoval:online" else 2)
else:
    out = words[words.index("--out") + 1]
    os.makedirs(out, exist_ok=True)
    kept = int(os.environ.get("KEPT", "90"))
    cell = {"sequence": "street", "name": "raymoval:online", "status": "ok",
            "method": {"version": "3", "control": False}, "data": {"fingerprint": "f"},
            "masks": {"digest": f"m{kept}"},
            "protocols": [{"name": "erasor", "version": "1", "counts": {"preserved_static": kept},
                           "rates": {"PR": float(kept), "RR": None, "F1": kept / 100}}]}
    json.dump({"cells": [cell]}, open(out + "/results.json", "w"))
    json.dump({"build": {"commit": os.environ.get("BUILT", "unknown"), "tree": "unknown"},
               "machine": {"processor": "Some (R) CPU @ 2 GHz"}}, open(out + "/run.json", "w"))
PROGRAM
chmod +x program
record=(house/scripts/record.sh --program program --rounds 0 --out lines)

tells 0 "1 lines added" "${record[@]}" --commit HEAD
file=$(ls lines)
holds "the machine is its processor: $file" grep -qE '^some-r-cpu-2-ghz-[0-9]+-threads.jsonl$' <<<"$file"
cp "lines/$file" before
tells 0 "0 lines added" "${record[@]}" --commit HEAD
holds "what is recorded stays as it is" cmp before "lines/$file"
KEPT=91 tells 1 "recorded with another answer" "${record[@]}" --commit HEAD
holds "an error adds nothing" cmp before "lines/$file"
BUILT=0000 tells 2 "was built from commit 0000" "${record[@]}" --commit HEAD
tells 2 "--commit goes with --program" house/scripts/record.sh --commit HEAD~1
tells 2 "expected lower-case letters" "${record[@]}" --commit HEAD --machine 'My PC'
tells 2 "no program" house/scripts/record.sh --program nothing --commit HEAD
tells 2 "--program goes with --commit" house/scripts/record.sh --program program --rounds 0 --out lines

# Lines are sorted by the dates of commits, which are whole seconds.
GIT_COMMITTER_DATE=2035-01-01T00:00:00Z "${git[@]}" commit -q --allow-empty -m two
second=$("${git[@]}" rev-parse HEAD)
KEPT=95 tells 0 "1 lines added" "${record[@]}" --commit HEAD
holds "lines are only added" cmp before <(head -n 1 "lines/$file")
echo more >>house/CMakeLists.txt
tells 2 "the tree is not clean" house/scripts/record.sh
tells 2 "CMakeLists.txt" house/scripts/record.sh
"${git[@]}" checkout -q CMakeLists.txt

# Lines that were recorded before and are not committed yet do not count as a change.
mkdir -p house/results/history bin
cp before house/results/history/desk.jsonl
"${git[@]}" add .
GIT_COMMITTER_DATE=2035-01-02T00:00:00Z "${git[@]}" commit -qm three
echo >>house/results/history/desk.jsonl
printf '#!/bin/sh\necho the build begins >&2\nexit 1\n' >bin/cmake
chmod +x bin/cmake
PATH=$PWD/bin:$PATH tells 2 "the build begins" house/scripts/record.sh

expect 0 "counts of erasor (F1 +0.0500)" history lines
expect 0 "${second:0:9}" history lines --format md
expect 0 "${first:0:9}" history lines --method raymoval --sequence street
holds "JSON has the change" python3 -c '
import json, subprocess, sys
tracks = json.loads(subprocess.check_output([sys.argv[1], "history", "lines", "--format", "json"]))["tracks"]
events = tracks[0]["events"]
assert [e["first"] for e in events] == [True, False]
assert events[1]["changes"] == ["counts of erasor"], events[1]
assert abs(events[1]["moved"]["PR"] - 5) < 1e-9
assert events[1]["commit"] == sys.argv[2]' "$raymoval" "$second"
expect 2 "no such folder" history nowhere
expect 2 "none of this name" history lines --method nothing
expect 2 "none of this name" history lines --sequence nothing
expect 2 "expected text, json or md" history lines --format pdf
expect 2 "at least 1" history lines --time-band 0.5

# From a reference: no program is needed, and there are no controls.
tells 0 "lines added" house/scripts/record.sh --reference "$first" --out references
holds "the lines of a reference are of no machine" test -s references/reference.jsonl
holds "controls are left out" test -z "$(grep -F oracle references/reference.jsonl)"
expect 0 "0.7.0" history references
tells 2 "nonsense: this repository has no such commit" house/scripts/record.sh --reference nonsense
tells 2 "it has no results/reference" house/scripts/record.sh --reference "$first" "$(
  "${git[@]}" commit-tree "$("${git[@]}" hash-object -t tree -w /dev/null)" -m empty)"
# The project's own.
expect 0 "street on reference" history "$source_folder/results/history"
finish history
