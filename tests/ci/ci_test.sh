#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The script for other projects' CI, on a repository with its own method, whose answers stay the same,
# get worse, and come from a committed reference. The action and the GitLab template call that script;
# the project's workflows, the Dockerfile and the devcontainer name only existing files.
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
PATH=$(dirname "$raymoval"):$PATH
script=scripts/workflow/check_method.sh

# A repository with a method: it removes points below a height above the sensor.
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

# says CODE TEXT COMMAND...: checks the exit code, and TEXT in the output.
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
export OPTIONS="--frames 0:2 --sensor vlp16" COMPARE="--across parameters,version --tolerance F1=0.005"
check() { METHOD=external:my_method/manifest.json env "$@" "$source_folder/$script"; }
reference=.raymoval-reference/results.json

says 0 "this run becomes it" check KEEP=yes
cp $reference ../first.json
says 0 "no regression" check
holds "there is a comparison to read" grep -q 'no regression' raymoval-out/compare.md
holds "there is JUnit without a failure" is_junit raymoval-out/compare.xml 0
remove_below 9.0
says 1 "worse" check
holds "JUnit has a failure" is_junit raymoval-out/compare.xml 1
says 1 "worse" check KEEP=yes
holds "what is worse does not become the reference" cmp $reference ../first.json
remove_below 3.0  # No higher moving point is there, so that fewer static ones are lost than by 9.
"$raymoval" compare raymoval-out/run .raymoval-reference --update >/dev/null
cp $reference ../committed.json
says 0 "no regression" check
holds "a reference is left alone unless it is to be kept" cmp $reference ../committed.json
says 0 "no regression" check KEEP=yes
holds "what is better becomes the reference" test "$(cmp $reference ../committed.json)" != ""
# Each run is worse by less than the tolerance: the reference does not sink with them.
cp $reference ../better.json
worse=(--tolerance F1=1 --tolerance PR=100 --tolerance RR=100)
remove_below 6.0
says 0 "" check KEEP=yes COMPARE="--across parameters,version ${worse[*]}"
holds "what is worse within the tolerance does not become the reference" cmp $reference ../better.json
# A tolerance of F1 excuses no fall of PR.
remove_below 9.0
says 1 "PR" check COMPARE="--across parameters,version --tolerance F1=1 --tolerance PR=0.5 --tolerance RR=100"
says 3 "building" check BUILD="echo building; exit 3"
says 2 "METHOD is empty" check METHOD=

# --- the action and the template call the script, with names that it has ---
mkdir ../view
cd ../view || exit 1
ln -s "$source_folder"/.[a-z]* "$source_folder"/[a-zA-Z]* .
holds "the example for GitHub uses the action" grep -q 'uses: OWNER/raymoval@VERSION' examples/ci/github.yml
for file in action.yml examples/ci/gitlab.yml; do
  holds "$file is read" "$python" -c 'import sys, yaml; yaml.safe_load(open(sys.argv[1]))' $file
  holds "$file calls the script" grep -q 'workflow/check_method.sh' $file
done
while read -r name; do
  holds "the script has the setting $name" grep -q "^#   $name " $script
done < <(grep -hoE '^ +(METHOD|BUILD|PROGRAM|SEQUENCE|OPTIONS|REFERENCE|COMPARE|OUT|KEEP):' action.yml examples/ci/gitlab.yml |
  tr -d ' :' | sort -u)
while read -r file; do
  holds "the workflows name $file, which is there" test -x "$file"
done < <(grep -hoE 'scripts/[a-z_]+\.(sh|py)' .github/workflows/*.yml | sort -u)
while read -r preset; do
  holds "there is the preset $preset" grep -q "\"name\": \"$preset\"" CMakePresets.json
done < <(grep -rhoE -- '--preset [a-z-]+' .github action.yml .devcontainer | awk '{ print $2 }' | sort -u)

# --- the container's files ---
for file in Dockerfile .devcontainer/Dockerfile; do
  while read -r path; do
    holds "$file: there is $path to copy" test -e "$path"
  done < <(sed -n 's/^COPY \([^-].*\) [^ ]*$/\1/p' "$file")
  user=$(sed -n 's/^USER //p' "$file" | tail -n 1)
  holds "$file: it runs as somebody who is not root" grep -qE "useradd .* $user( |\$)" "$file"
done
holds "devcontainer.json is read" "$python" -c 'import json
given = json.load(open(".devcontainer/devcontainer.json"))
assert given["remoteUser"] in open(".devcontainer/" + given["build"]["dockerfile"]).read()'
finish ci
