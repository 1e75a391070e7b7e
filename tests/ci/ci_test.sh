#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What others' CI runs: the action and the GitLab template are run on a repository with a method of its
# own, whose answers stay the same, get worse, and come from a committed reference. The project's own
# workflows, the Dockerfile and the devcontainer name only what is there.
# Usage: ci_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source_folder=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../..")
for python in /usr/bin/python3 python3; do "$python" -c 'import yaml' 2>/dev/null && break; python=; done
if [[ -z $python ]]; then
  echo "SKIPPED: no Python with yaml; run scripts/install_dependencies.sh --tests" >&2
  exit 77
fi
source "$source_folder/tests/cli/checks.sh"
workflow=("$python" -B "$source_folder/tests/ci/run_workflow.py")
PATH=$(dirname "$raymoval"):$PATH


# A repository with a method: it removes what is lower than so many metres above the sensor.
mkdir -p repository/my_method
cd repository || exit 1
cat >my_method/manifest.json <<'JSON'
{ "name": "low", "sentence": "Removes low points.", "source": "a test", "version": "1", "online": false,
  "command": ["python3", "{here}/method.py"], "parameters": [] }
JSON
cat >my_method/method.py <<'PYTHON'
import array, os, pathlib
LIMIT = 0.0
os.makedirs("predictions", exist_ok=True)
for scan in sorted(pathlib.Path("velodyne").iterdir()):
    values = array.array("f", scan.read_bytes())
    answers = array.array("I", (251 if z < LIMIT else 9 for z in values[2::4]))
    pathlib.Path("predictions", scan.stem + ".label").write_bytes(answers.tobytes())
PYTHON
remove_below() { sed -i "s/^LIMIT = .*/LIMIT = $1/" my_method/method.py; }

# says CODE TEXT COMMAND...: the exit code, and TEXT in what it prints.
says() {
  checks=$((checks + 1))
  "${@:3}" >out.txt 2>err.txt
  local got=$?
  [[ $got -eq $1 ]] || { complain "${*:3}: exit code $got, expected $1"; return; }
  grep -qF -- "$2" out.txt err.txt || complain "${*:3}: does not say '$2'"
}
is_junit() {
  "$python" -c 'import sys, xml.etree.ElementTree as t
suites = t.parse(sys.argv[1]).getroot()
sys.exit(suites.tag != "testsuites" or int(suites.get("failures")) != int(sys.argv[2]))' "$@"
}

# --- the action, as the example for GitHub uses it ---
# check BRANCH RUN [OPTION...]
check() {
  "${workflow[@]}" used.yml --cache ../cache --set "github.ref_name=$1" --set "github.run_id=$2" "${@:3}"
}
ln -s "$source_folder" raymoval
sed 's|OWNER/raymoval@VERSION|./raymoval|; s|^\( *\)method: .*|&\n\1options: --frames 0:2 --sensor vlp16|' \
  "$source_folder/examples/ci/github.yml" >used.yml
holds "the example uses the action" grep -q 'uses: ./raymoval' used.yml

says 0 "this run becomes it" check main 1
says 0 "no regression" check 7/merge 2
holds "there is a comparison to read" grep -q 'no regression' raymoval-out/compare.md
holds "there is JUnit without a failure" is_junit raymoval-out/compare.xml 0
rm -r .raymoval-reference
remove_below 9.0
says 1 "worse" check 7/merge 3
holds "JUnit has a failure" is_junit raymoval-out/compare.xml 1
rm -r .raymoval-reference
says 1 "worse" check main 4
rm -r .raymoval-reference
says 1 "worse" check 8/merge 5  # What is worse has not become the reference.
# A reference in the repository counts, whatever is in the cache, and is left alone.
says 0 "wrote" "$raymoval" compare raymoval-out/run .raymoval-reference --update
cp .raymoval-reference/results.json ../committed.json
rm -rf ../cache
says 0 "no regression" check main 6
holds "a committed reference stays" cmp .raymoval-reference/results.json ../committed.json
holds "a committed reference is not cached" test ! -e ../cache
sed 's|^\( *\)build: .*|\1build: exit 3|' used.yml >broken.yml
says 3 "Build the method" "${workflow[@]}" broken.yml
sed 's|^\( *\)method: .*|\1methods: noop|' used.yml >broken.yml
says 2 "the input 'method' is missing" "${workflow[@]}" broken.yml

# --- the template for GitLab ---
# gitlab BRANCH: its script, as one of GitLab's runners does it: one shell, which ends at a failure.
gitlab() {
  "$python" - "$source_folder/examples/ci/gitlab.yml" >job.sh <<'PYTHON'
import sys, shlex, yaml
job = yaml.safe_load(open(sys.argv[1]))["raymoval"]
variables = {**job["variables"], "OPTIONS": "--frames 0:2 --sensor vlp16"}
print("set -e")
for name, value in variables.items():
    print(f"export {name}={shlex.quote(value)}")
print("\n".join(job["script"]))
PYTHON
  CI_COMMIT_BRANCH=$1 CI_DEFAULT_BRANCH=main bash job.sh
}
rm -rf raymoval-out
remove_below 0.0
says 0 "this run becomes it" gitlab main
says 0 "no regression" gitlab change
cp raymoval-reference/results.json ../first.json
remove_below 9.0
says 1 "worse" gitlab change
holds "GitLab has JUnit with a failure" is_junit raymoval-out/compare.xml 1
says 1 "worse" gitlab main
holds "what is worse does not become the reference" cmp raymoval-reference/results.json ../first.json
remove_below -9.0
"$raymoval" compare raymoval-out/run raymoval-reference --update >/dev/null
says 0 "no regression" gitlab change

# --- the project's own workflows: those steps that need neither another system nor a build ---
mkdir ../view
cd ../view || exit 1
ln -s "$source_folder"/.[a-z]* "$source_folder"/[a-zA-Z]* .
for file in .github/workflows/*.yml; do
  for job in $("$python" -c 'import sys, yaml; print(*yaml.safe_load(open(sys.argv[1]))["jobs"])' "$file"); do
    holds "$file: the matrix of $job" "${workflow[@]}" "$file" --job "$job" --list
  done
  while read -r script; do
    holds "$file: there is $script" test -x "$script"
  done < <(grep -oE 'scripts/[a-z_]+\.(sh|py)' "$file" | sort -u)
done
while read -r preset; do
  holds "there is the preset $preset" grep -q "\"name\": \"$preset\"" CMakePresets.json
done < <(grep -rhoE -- '--preset [a-z-]+' .github action.yml .devcontainer | awk '{ print $2 }' | sort -u)
version=$(sed -n 's/^project(raymoval VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
release=("${workflow[@]}" .github/workflows/release.yml --job packages --only "The tag")
holds "the tag of this version is released" "${release[@]}" --set "github.ref_name=v$version"
says 2 "The tag is v0.0.1" "${release[@]}" --set github.ref_name=v0.0.1

# --- the container's files ---
for file in Dockerfile .devcontainer/Dockerfile; do
  while read -r path; do
    holds "$file: there is $path to copy" test -e "$path"
  done < <(sed -n 's/^COPY \([^-].*\) [^ ]*$/\1/p' "$file")
  user=$(sed -n 's/^USER //p' "$file" | tail -n 1)
  holds "$file: it runs as somebody who is not root" grep -qE "useradd .* $user( |\$)" "$file"
done
holds "devcontainer.json is read" "$python" -c 'import json, sys
given = json.load(open(sys.argv[1]))
assert given["remoteUser"] in open(".devcontainer/" + given["build"]["dockerfile"]).read()' \
  .devcontainer/devcontainer.json
says 2 "there is no no-engine" scripts/container.sh --engine no-engine

finish ci
