#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The three lines that each page of docs/recipes/ begins with, run on small files that recipe_data.py
# makes under the names of the page.
# Usage: recipes_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source_folder=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../..")
source "$source_folder/tests/cli/checks.sh"
pages=$source_folder/docs/recipes
export RAYMOVAL_CACHE=$work/cache

# lines PAGE: the commands that it begins with.
lines() { awk '/^    raymoval / { print; found = 1; next } found { exit }' "$1"; }
# points FILE: those of a .pcd or .ply.
points() { grep -am1 -oE '^(POINTS|element vertex) [0-9]+' "$1" | grep -oE '[0-9]+$'; }

sparse_vlp16 >sparse.json
expect 0 "6 scans" simulate suburb -o drive --scans 6 --sensor sparse.json --seed 5 --quiet
all=$(($(cat drive/velodyne/*.bin | wc -c) / 16))

for page in "$pages"/*.md; do
  name=$(basename "$page" .md)
  [[ $name != README ]] || continue
  holds "the list has $name" grep -qF "($name.md)" "$pages/README.md"
  holds "$name begins with three lines" test "$(lines "$page" | wc -l)" -eq 3
  holds "$name has its data" python3 -B "$source_folder/tests/cli/recipe_data.py" "$work/drive" "$name" "$work/$name"
  cd "$work/$name" || exit 1
  ln -s "$source_folder/examples" examples
  while read -ra words; do
    holds "$name: ${words[*]}" "${words[@]}"
  done < <(grep '^    python3 ' "$page")
  while read -r _ words; do
    read -ra words <<<"$words"
    quick=(--quiet)
    [[ ${words[0]} != clean ]] || quick+=(--method raymoval:online)
    expect 0 "" "${words[@]}" "${quick[@]}"
    cp out.txt said.txt
    for ((i = 1; i + 1 < ${#words[@]}; ++i)); do
      case ${words[i]} in
        -o | --dynamic | --scans | --html | --picture)
          holds "$name: ${words[i]} ${words[i + 1]} is there" test -e "${words[i + 1]}" ;;
      esac
    done
    if [[ " ${words[*]} " == *" --scans "* && ${words[0]} == clean ]]; then
      opened=$(grep -oP '(?<=open with: raymoval ).*' said.txt)
      expect 0 "0 findings" $opened --quiet
      expect 0 "" clean ${opened#inspect } --method noop --quiet -o again.ply
    fi
  done < <(lines "$page")
  kept=$(ls static.* 2>/dev/null) removed=$(ls removed.* 2>/dev/null)
  [[ ! -e again.ply ]] || holds "$name: the cleaned scans have what the map has" \
    test "$(points again.ply)" -eq "$(points "$kept")"
  holds "$name: no point is lost" test "$(($(points "$kept") + $(points "$removed")))" -eq "$all"
  cd "$work" || exit 1
done
finish recipes
