#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the tracked files: no unknown entry at the top level, no large file, no binary file except
# pictures and the fuzzers' inputs. Outputs of a run are easily added by accident.
#
#   scripts/check_tree.sh [FOLDER]      default: this repository
set -euo pipefail
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
  -*) echo "check_tree.sh: '$1' is unknown; expected a folder or nothing." >&2; exit 2 ;;
esac
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

known='.ci .clang-format .devcontainer .dockerignore .github Dockerfile action.yml .clang-tidy .gitattributes .gitignore .pre-commit-config.yaml CHANGELOG.md CITATION.cff CMakeLists.txt
CMakePresets.json CONTRIBUTING.md LICENSE README.md SECURITY.md benchmark cmake core datasets docs eval examples methods pyproject.toml python results
scripts tests'
most_bytes=1048576

bad=0
complain() {
  echo "check_tree.sh: $1" >&2
  bad=1
}

if ! git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
  echo "check_tree.sh: no git repository, so nothing is tracked; not checked."
  exit 0
fi
while read -r entry; do
  grep -qxF "$entry" <<<"${known//[[:space:]]/$'\n'}" ||
    complain "$entry: unknown at the top level. Remove it (git rm -r --cached), or add it to the list in scripts/check_tree.sh."
done < <(git ls-files | cut -d/ -f1 | sort -u)

while read -r bytes file; do
  [[ $bytes -le $most_bytes ]] ||
    complain "$file: $bytes bytes, more than $most_bytes. Large files are made or fetched, not kept."
done < <(git ls-files -z | xargs -0 -r stat -c '%s %n' 2>/dev/null)

may_be_binary='^(results/pictures/[^/]+\.png|tests/fuzz/corpus/.*)$'
data='\.(pcd|ply|bin|label|npy|zip|gz|so|o|a)$'
while read -r file; do
  complain "$file: data or build output. Tests write what they need; runs belong elsewhere."
done < <(git ls-files | grep -vE "$may_be_binary" | grep -E "$data")
# Files without a line of text are empty, or hold a zero byte.
while read -r file; do
  [[ ! -s $file ]] || complain "$file: a binary file."
done < <(git ls-files | grep -vE "$may_be_binary" | LC_ALL=C xargs -r -d '\n' grep -LI '' 2>/dev/null)
[[ $bad -eq 0 ]] && echo "check_tree.sh: nothing is tracked that does not belong."
exit $bad
