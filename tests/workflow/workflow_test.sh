#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The Snakemake workflow on this machine ends with the files of a plain run; what changes is run
# again and nothing else; a failed cell is a result.
# Usage: workflow_test.sh PATH/TO/raymoval_faulty
set -uo pipefail
raymoval=$(readlink -f "$1")
source_folder=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../..")
source "$source_folder/tests/cli/checks.sh"
if ! command -v snakemake >/dev/null; then
  echo "workflow_test.sh: snakemake is missing; run scripts/install_dependencies.sh --tests" >&2
  exit 1
fi

# workflow SUITE OUT: the exit code of the workflow, what it said in workflow.txt.
workflow() {
  HOME=$work snakemake -s "$source_folder/scripts/workflow/Snakefile" --cores 2 --keep-going \
    --config "raymoval=$raymoval" "suite=$1" "out=$2" "options=--memory-limit 2000" \
    >workflow.txt 2>&1
}
cells_run() { grep -c '^rule cell:' workflow.txt; }

cat >suite.json <<'JSON'
{ "sequences": [{"path": "street", "name": "a", "frames": "0:2"},
                {"path": "street", "name": "b", "frames": "3:4"}],
  "methods": ["comb", {"method": "comb2", "set": {"milliseconds": {"sweep": [0, 1]}}}],
  "threads": 1 }
JSON
expect 0 "All controls are as they must be" run suite.json --quiet --out plain
workflow suite.json flow
holds "the workflow ends well" test $? -eq 0
holds "each of the 12 cells was a job" test "$(cells_run)" -eq 12
holds "its files are those of a plain run" same_but_times plain flow
workflow suite.json flow
holds "a second time nothing is to do" grep -q "Nothing to be done" workflow.txt
sleep 1  # Snakemake looks at the times of files.
sed -i 's/"sweep": \[0, 1\]/"sweep": [0, 2]/' suite.json
workflow suite.json flow
holds "after a change two cells are run" test "$(cells_run)" -eq 2
sleep 1
sed -i 's/"comb",/"comb", "crash",/' suite.json
workflow suite.json flow
code=$?
holds "a failed cell is told by the exit code" test $code -ne 0
holds "the others have their results" grep -q "^b,comb,default,erasor,ok" flow/results.csv
holds "and it has its reason" grep -q "crashed: signal 11" flow/results.json
finish workflow
