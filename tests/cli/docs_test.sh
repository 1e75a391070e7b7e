#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The README and docs/ are true: their links are valid, the program accepts every command in them,
# and short commands are run on small data. Data, runs and scenes that pages assume (data/05, out/05,
# ...) are made here, newly for each page.
# Usage: docs_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source_folder=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../..")
source "$source_folder/tests/cli/checks.sh"
mapfile -t pages < <(cd "$source_folder" && ls README.md docs/*.md)
mapfile -t recipes < <(cd "$source_folder" && ls docs/recipes/*.md)  # recipes_test.sh runs them.
page_text() { cat "$source_folder/$1"; }

# --- links ---
# anchors PAGE: what #... may lead to.
anchors() {
  sed -n 's/^##* //p' "$1" | tr '[:upper:]' '[:lower:]' | sed 's/[^a-z0-9 _-]//g; s/ /-/g'
}
for page in "${pages[@]}" "${recipes[@]}" CONTRIBUTING.md methods/README.md examples/cpp_method/README.md; do
  while read -r link; do
    target=$source_folder/$(dirname "$page")/${link%%#*}
    [[ $link != \#* ]] || target=$source_folder/$page
    holds "$page: $link leads somewhere" test -e "$target"
    [[ $link == *#* ]] || continue
    holds "$page: $link is a heading" grep -qxF -- "${link#*#}" <(anchors "$target")
  done < <(page_text "$page" | grep -oE '\]\([^)]+\)' | sed 's/^](//; s/)$//' | grep -v '^https\?:')
done
# Each page can be reached from the README: it is linked there, or on a page that is.
mapfile -t near < <(page_text README.md | grep -oE '\]\([A-Za-z_/.-]+\.md' | sed 's/^](//' | sort -u)
for page in "${pages[@]}"; do
  [[ $page == README.md ]] || holds "the README, or a page that it links to, links to $page" \
    grep -qE "\]\(($page|(docs/)?${page##*/})[)#]" "$source_folder/README.md" "${near[@]/#/$source_folder/}"
done
# A screen and a half, and its first columns are those of the page that has all.
holds "README.md is short" test "$(page_text README.md | wc -l)" -le 80
while read -r row; do
  holds "docs/scores.md has the README's row $row" grep -qF -- "${row//](methods/](../methods}" "$source_folder/docs/scores.md"
done < <(page_text README.md | grep -E '^\|.*[0-9]+\.[0-9]+ \|' | cut -d'|' -f1-5)
holds "the README has a row for each method" test "$(page_text README.md | grep -cE '^\| \[[a-z_]+\]\(methods/')" -eq \
  "$(find "$source_folder/methods" -mindepth 2 -maxdepth 2 -name README.md | wc -l)"
# Code on a page is in a file: each of its lines, except for leading blanks.
while read -r page file; do
  while read -r line; do
    holds "$page: $file has '$line'" grep -qF -- "$line" "$source_folder/$file"
  done < <(page_text "$page" | sed -n 's/^    //p')
done <<'END'
docs/add-data-set.md datasets/dynamicmap.cpp
docs/add-protocol.md tests/eval/toy_protocol.h
END

# --- options: each is one of the program's or of a script's, or known to be another program's ---
commands=$("$raymoval" --help | sed -n '/^Subcommands:/,/^$/p' | awk 'NR > 1 && NF { print $1 }')
for command in $commands; do
  "$raymoval" "$command" --help | grep -oE '^  (-[a-zA-Z],)?--[a-z-]+(,--[a-z-]+)*|^  -[a-zA-Z] ' |
    tr ',' '\n' | tr -d ' ' >"options.$command"
done
{
  cat options.*
  echo --version
  grep -ohE -- '--[a-z][a-z-]+' "$source_folder"/scripts/*.sh "$source_folder"/scripts/workflow/*.sh
  # Of cmake, snakemake, Python and containers.
  printf '%s\n' --preset --build --cores --config --profile --system-site-packages --build-arg --rm --userns
} | sort -u >known_options
for page in "${pages[@]}"; do
  for option in $(page_text "$page" | grep -oE -- '(^|[^a-z-])--[a-z][a-z-]+' | grep -oE -- '--.*' | sort -u); do
    holds "$page: there is an option $option" grep -qxF -- "$option" known_options
  done
done

# --- commands ---
# check_command PAGE WORD...: the words after "raymoval" begin with a command and have its options.
check_command() {
  local page=$1 command=${2:-} word
  shift 2
  [[ $command != -* ]] || return 0
  holds "$page: there is a command 'raymoval $command'" grep -qxF -- "$command" <<<"$commands" || return
  for word in "$@"; do
    [[ $word == -[a-zA-Z-]* && $word != -[0-9]* ]] || continue
    holds "$page: raymoval $command has $word" grep -qxF -- "${word%%=*}" "options.$command"
  done
}
# code_lines PAGE: lines of its code blocks, without comments behind them.
code_lines() { page_text "$1" | grep -E '^    [^ ]' | sed -E 's/^    //; s/  +#.*$//; s/ # .*$//'; }
# spans PAGE: the texts between backticks, one per line.
spans() { page_text "$1" | grep -v '^    ' | tr '\n' ' ' | grep -oE '`[^`]+`' | tr -d '`'; }
for page in "${pages[@]}" CONTRIBUTING.md methods/README.md examples/cpp_method/README.md; do
  while read -r line; do
    line=${line%%|*}  # The rest is for another program.
    eval "words=(${line//[<>()]/ })" 2>/dev/null || continue
    check_command "$page" "${words[@]:1}"
  done < <({ code_lines "$page"; spans "$page"; } | grep -oE '(^|\()raymoval( .*)?$' | tr -d '(' | grep -v '^raymoval$')
  while read -r script rest; do
    holds "$page: there is $script" test -x "$source_folder/$script"
  done < <({ code_lines "$page"; spans "$page"; } | grep -E '^scripts/[a-z_/]+\.sh')
done

# Pages of methods, which a formatter of code may have taken for code.
for page in "$source_folder"/methods/*/README.md; do
  holds "$page begins with its title" grep -qE -m 1 '^# [A-Za-z]' <(head -n 1 "$page")
done

# --- running them ---
export RAYMOVAL_CACHE=$work/cache
mkdir -p ready/kitti/sequences ready/out
cd ready || exit 1
sparse_vlp16 >sparse.json
expect 0 "" simulate town -o data/05 --scans 12 --sensor sparse.json --quiet
ln -s ../../data/05 kitti/sequences/05
ln -s data/05/labels labels
ln -s "$source_folder/examples" examples
ln -s "$source_folder/results" results
mkdir my_scans
cp data/05/velodyne/*.bin my_scans/
# Poses of the LiDAR from those of the camera: Tr^-1 P Tr, each a 3 x 4 matrix row by row.
awk 'function times(a, b, c,    i, j) {  # c = a b
       for (i = 0; i < 3; ++i) for (j = 0; j < 4; ++j)
         c[4*i+j] = a[4*i]*b[j] + a[4*i+1]*b[4+j] + a[4*i+2]*b[8+j] + (j == 3 ? a[4*i+3] : 0)
     }
     /^Tr:/ {
       for (i = 0; i < 12; ++i) tr[i] = $(i + 2)
       for (i = 0; i < 3; ++i) for (j = 0; j < 3; ++j) inverse[4*i+j] = tr[4*j+i]
       for (i = 0; i < 3; ++i) inverse[4*i+3] = -(tr[i]*tr[3] + tr[4+i]*tr[7] + tr[8+i]*tr[11])
     }
     NF == 12 {
       for (i = 0; i < 12; ++i) p[i] = $(i + 1)
       times(inverse, p, half); times(half, tr, lidar)
       for (i = 0; i < 12; ++i) printf "%.9g%s", lidar[i], i < 11 ? " " : "\n"
     }' data/05/calib.txt data/05/poses.txt >my_scans/poses.txt
# What docs/poses.md is about: recordings and the trajectories that other programs made of them.
for recipe in glim livox; do
  holds "there is data for $recipe" python3 -B "$source_folder/tests/cli/recipe_data.py" data/05 $recipe .
done
mv dump/traj_lidar.txt .
holds "there are labelled scans of a recording" \
  python3 -B "$source_folder/tests/cli/recipe_data.py" data/05 doals station/sequence_1
# The suite of the page, on small data.
sed -n '/^    {$/,/^    }$/p' "$source_folder/docs/compare-methods.md" |
  sed 's/scans=60/scans=3,sensor=vlp16/; s/0:200:2/0:6:2/' >my_suite.json
holds "the page of suites has a suite" grep -q '"sweep"' my_suite.json
run=(run --sequence data/05 --quiet)
expect 0 "" "${run[@]}" --method raymoval_plus --method raymoval:online --keep-removals --name 05 --out out/05
for name in old new; do expect 0 "" "${run[@]}" --method raymoval:online --out out/$name; done
expect 0 "" clean data/05 -o static.pcd --method raymoval:online --quiet --html map.html
edits_of map.html >edits.json
rm map.html
cd "$work" || exit 1

# These take long or need what is not here; that they are understood is checked above.
not_run='^(run (quick|field|simulated|simulated-quick|semantickitti) |compare out/quick |cannot be built here)'
# The example of a method in Python.
export RAYMOVAL_PYTHON=/usr/bin/python3
if ! $RAYMOVAL_PYTHON -c 'import numpy' 2>/dev/null; then
  not_run=${not_run%)}'|.*external:)'
  echo "docs_test.sh: /usr/bin/python3 has no numpy; the external method is not run."
fi
ran=0
for page in "${pages[@]}"; do
  cp -r ready sandbox
  cd sandbox || exit 1
  # What a page makes itself is not there before.
  [[ $page == docs/compare-methods.md ]] || rm static.pcd
  [[ $page != README.md ]] || rm -r out/05
  while read -r line; do
    line=${line#raymoval }
    [[ $line =~ $not_run ]] && continue
    line=${line//\/data\/kitti/kitti}
    line=${line//--scans 100/--scans 3 --sensor vlp16}
    line=${line/#clean street/clean street --frames 0:9}
    line=${line//--sequence street/--sequence street --frames 0:9}
    line=${line//town:scans=60/town:scans=3,sensor=vlp16}
    eval "words=($line)"
    ran=$((ran + 1))
    case $line in
      # Small data need not be good data: findings are an answer.
      inspect*) "$raymoval" "${words[@]}" --quiet >out.txt 2>err.txt
        holds "$page: raymoval $line: done, or findings" test $? -le 1 ;;
      # Cells that no machine has run are missing, which it says.
      *--collect*) "$raymoval" "${words[@]}" --quiet >out.txt 2>err.txt
        holds "$page: raymoval $line: done, or cells are missing" test $? -le 1 ;;
      *) expect 0 "" "${words[@]}" ;;
    esac
  done < <(code_lines "$page" | grep '^raymoval ' | grep -v '|')
  cd "$work" || exit 1
  rm -rf sandbox
done
holds "commands of the pages were run: $ran" test "$ran" -ge 40
echo "docs_test.sh: $ran commands were run"
finish docs
