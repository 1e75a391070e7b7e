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
  echo "workflow_test.sh: snakemake is missing; run scripts/install_dependencies.sh --all" >&2
  exit 1
fi

# workflow SUITE OUT: the exit code of the workflow; its output is in workflow.txt.
workflow() {
  HOME=$work snakemake -s "$source_folder/scripts/workflow/Snakefile" --cores 2 --keep-going \
    --config "raymoval=$raymoval" "suite=$1" "out=$2" "options=--memory-limit 2000" \
    >workflow.txt 2>&1
}
cells_run() { grep -c '^rule cell:' workflow.txt; }

cat >suite.json <<'JSON'
{ "sequences": [{"path": "street", "name": "a $(touch hacked);`id` 'q\" *?[x]{y}", "frames": "0:2"},
                {"path": "street", "name": "b", "frames": "3:4"}],
  "methods": ["comb", {"method": "comb2", "set": {"milliseconds": {"sweep": [0, 1]}}}],
  "threads": 1 }
JSON
expect 0 "All controls have their expected scores" run suite.json --quiet --out plain
workflow suite.json flow
holds "the workflow ends well" test $? -eq 0
holds "each of the 12 cells was a job" test "$(cells_run)" -eq 12
holds "its files are those of a plain run" same_but_times plain flow
holds "no name was run by a shell" test ! -e hacked
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

# An installed copy, called from another folder: it finds the program beside it, and the profile
# finds its script. sbatch and scontrol are replaced by scripts that run each job at once.
mkdir -p installed/bin installed/share/raymoval stubs elsewhere
ln -s "$raymoval" installed/bin/raymoval
cp -r "$source_folder/scripts/workflow" installed/share/raymoval/
cat >stubs/sbatch <<'STUB'
#!/usr/bin/env bash
echo "$*" >>"$SLURM_STUB/submitted"
bash "${@: -1}" >"$SLURM_STUB/job.txt" 2>&1 && state=COMPLETED || state=FAILED
number=$(wc -l <"$SLURM_STUB/submitted")
echo "JobId=$number JobState=$state" >"$SLURM_STUB/job.$number"
echo "$number"
STUB
printf '#!/usr/bin/env bash\ncat "$SLURM_STUB/job.${@: -1}"\n' >stubs/scontrol
chmod +x stubs/*
cat >small.json <<'JSON'
{ "sequences": [{"path": "street", "frames": "0:2"}], "methods": ["comb"], "controls": false }
JSON
# installed_workflow SNAKEFILE OPTIONS...: called from the folder elsewhere, with these scripts.
installed_workflow() {
  (cd elsewhere && HOME=$work PATH=$work/stubs:$PATH SLURM_STUB=$work/stubs snakemake -s "$@") \
    >workflow.txt 2>&1
}
installed_workflow "$work/installed/share/raymoval/workflow/Snakefile" \
  --profile "$work/installed/share/raymoval/workflow/slurm" --latency-wait 5 \
  --max-status-checks-per-second 10 --config "suite=$work/small.json" "out=$work/by_slurm" \
  "options=--memory-limit 2000"
holds "an installed workflow ends well: $(tail -3 workflow.txt)" test $? -eq 0
holds "its cell was a job of Slurm" grep -q -- "--mem=4000 --time=120" stubs/submitted
expect 0 "" run small.json --quiet --out plain_small
holds "its files are those of a plain run" same_but_times plain_small by_slurm
mkdir copied
cp "$source_folder/scripts/workflow/Snakefile" copied/
installed_workflow "$work/copied/Snakefile" --cores 1 -n --config suite=quick out=x
holds "without a program: it says what to do" grep -q "or say where it is" workflow.txt
ln -s "$raymoval" stubs/raymoval
installed_workflow "$work/copied/Snakefile" --cores 1 -n -p --config suite=quick out=x
holds "a program in PATH is found" grep -q "^$work/stubs/raymoval plan quick" workflow.txt
finish workflow
