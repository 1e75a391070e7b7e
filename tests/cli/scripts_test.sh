#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Every script has a help text, works from any folder, and refuses unknown arguments before it does
# anything.
set -uo pipefail
scripts=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scripts" && pwd)
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

# tells CODE TEXT SCRIPT ARGUMENTS...: the exit code, and TEXT somewhere in the output.
tells() {
  checks=$((checks + 1))
  timeout 20 "$3" "${@:4}" >out.txt 2>err.txt
  local got=$?
  [[ $got -eq $1 ]] && grep -qF -- "$2" out.txt err.txt ||
    complain "${*:3}: exit code $got, expected $1 and '$2'"
}

ln -s "$scripts" scripts
for script in scripts/*.sh scripts/workflow/check_method.sh; do
  tells 0 "$script" "$script" --help
  holds "$script --help is its head only" test -z "$(grep -e '^set ' -e '^#' <("$script" --help))"
  tells 2 "--nonsense" "$script" --nonsense
done

# Unclear phrases: in pages without their code, in sources only in comments.
printf '%s\n' 'A voxel is free.' 'What is told stands anyway.' '' '    those that' >page.md
printf '%s\n' 'const char* text = "those that";' 'int a = 0;  // Those that move.' >source.h
holds "dialect.sh finds unclear phrases" test "$(scripts/dialect.sh page.md source.h)" = \
  "page.md:2:What is told stands anyway.
source.h:2:int a = 0;  // Those that move."
tells 2 "gone.md" scripts/dialect.sh gone.md

# The version is in CMakeLists.txt; files that cannot read it there have the same.
house=$(readlink -f "$scripts/..")
version=$(sed -nE 's/^project\(raymoval VERSION ([0-9.]+).*/\1/p' "$house/CMakeLists.txt")
holds "CITATION.cff has version $version" grep -qx "version: $version" "$house/CITATION.cff"
holds "the newest entry of CHANGELOG.md is $version" test "$version" = \
  "$(sed -nE 's/^## ([0-9.]+).*/\1/p' "$house/CHANGELOG.md" | head -n 1)"
holds "a page names the packages of $version" grep -q "raymoval_${version}_amd64.deb" "$house/docs/getting-started.md"
holds "CITATION.cff has no DOI that is none" test -z \
  "$(grep -E '^doi:' "$house/CITATION.cff" | grep -vE '^doi: 10\.[0-9]{4,9}/[^ ]+$')"

# The commit of the build: read in each build, written only if it has changed.
# asks FOLDER: the commit and the tree of FOLDER in the generated source.
asks() {
  cmake -DSOURCE="$PWD/$1" -DOUTPUT="$PWD/commit.cpp" -P "$scripts/../cmake/build_commit.cmake"
  sed -n 's/.*return "\(.*\)".*/\1/p' commit.cpp | paste -sd' '
}
mkdir -p plain repository/core
holds "without a repository the commit is unknown" test "$(asks plain)" = "unknown unknown"
echo 0123456789abcdef >plain/COMMIT
holds "an archive says its commit" test "$(asks plain)" = "0123456789abcdef unknown"
if command -v git >/dev/null; then
  git=(git -C repository -c user.name=n -c user.email=e@example.org)
  "${git[@]}" init -q
  echo one >repository/core/a.cpp
  "${git[@]}" add -A
  "${git[@]}" commit -qm one
  commit=$("${git[@]}" rev-parse HEAD)
  holds "a repository has its commit" test "$(asks repository)" = "$commit clean"
  touch -d 2001-01-01 commit.cpp
  asks repository >said.txt
  holds "what is known is not written again" test "$(date -r commit.cpp +%Y)" = 2001
  echo two >repository/results.csv
  holds "results do not change the tree" test "$(asks repository)" = "$commit clean"
  echo two >repository/core/a.cpp
  holds "sources do" test "$(asks repository)" = "$commit changed"
  mkdir -p repository/inner
  holds "a folder within another repository is none of it" \
    test "$(asks repository/inner)" = "unknown unknown"
fi
finish scripts
