#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Hostile names, which could run, show or overwrite something: a name that no escape makes harmless is
# refused from any source, and other names are text in every output.
# Usage: hostile_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
export RAYMOVAL_CACHE=$work/cache

# clean FILE...: nothing that steers a terminal, and no change of the direction of writing.
clean() { ! LC_ALL=C grep -qP '[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80[\xaa-\xae]' "$@"; }
# refused NAME ARGUMENTS...: refused because of this name, in words that a terminal may show.
names=0
refused() {
  names=$((names + 1))
  expect 2 "${@:2}"
  holds "the message about '${1@Q}' is text" clean "$work/out.txt" "$work/err.txt"
}
run=(run --method noop --frames 0:0 --quiet --in-process --threads 1)

hostile=('=cmd|x' '+1' '-1+1' '--help' '@SUM(A1)' ' [2pt]' 'a ' $'\e[2Jx' $'a\e]0;t\a' $'a\rb' $'a\nb' $'a\tb'
  $'a\x7f' $'\xc2\x9b2J' $'\u202egpj' $'\u2066a' $'a\u200bb' $'a\u2028b' $'\xff' $'\xed\xa0\x80' '../up' '/abs' '.'
  '..' '.hidden' 'a\b' "$(printf 'a%.0s' {1..201})")
for name in "${hostile[@]}"; do
  refused "$name" "sequence name" "${run[@]}" --sequence street --name="$name" --out run
done
holds "nothing is written under such names" test ! -e run/results.json
# The other places that names come from: folders, sequence.json, suites, manifests.
expect 0 "" simulate town:scans=1,sensor=vlp16 -o seq --quiet
some=('=1' $'\e[2Jx' $'\u202ex' '-x')
for name in "${some[@]}"; do
  cp -r seq "./$name"
  sed -i '/"name"/d' "./$name/sequence.json"
  refused "$name" "sequence name" "${run[@]}" --sequence "./$name" --out run
  quoted=$(python3 -c 'import json, sys; print(json.dumps(sys.argv[1]))' "$name")
  cp -r seq named
  printf '{ "name": %s }' "$quoted" >named/sequence.json
  refused "$name" "sequence name" "${run[@]}" --sequence named --out run
  rm -r named
  printf '{ "sequences": ["street"], "methods": ["noop"], "name": %s }' "$quoted" >suite.json
  refused "$name" "of the suite" run suite.json --out run --quiet
  printf '{ "sequences": ["street"], "methods": [{ "method": "noop", "as": %s }] }' "$quoted" >suite.json
  refused "$name" "cannot name a result" run suite.json --out run --quiet
  printf '{ "name": %s, "sentence": "S.", "source": "t", "version": "1", "online": false, "command": ["true"] }' \
    "$quoted" >manifest.json
  refused "$name" "the name" "${run[@]}" --sequence street --method external:manifest.json --out run
done

# Names that only need escapes, in one run; the shell would run some of them.
odd=('<script>alert(1)<b>' 'a&amp;b' '$(touch hacked)' '`touch hacked`' 'a;touch hacked' "q'\"q" '*?[x]{y}'
  '![x](http:x)' '[x](javascript:x)' '| a | b |' '**b** _i_' '%n%s #1 ~^' 'a,b;c' $'straße 道')
sequences=
for name in "${odd[@]}"; do
  names=$((names + 1))
  quoted=$(python3 -c 'import json, sys; print(json.dumps(sys.argv[1]))' "$name")
  sequences+="${sequences:+, }{ \"path\": \"street\", \"frames\": \"0:0\", \"name\": $quoted }"
done
echo "{ \"name\": \"[s](x) <i> & \`c\`\", \"controls\": false, \"methods\": [\"octomap\"], \"sequences\": [$sequences] }" >suite.json
expect 0 "" run suite.json --out run --quiet --in-process --threads 1
"$raymoval" report run --no-points -o run.html --quiet >/dev/null
"$raymoval" compare run run --format junit >run.xml
"$raymoval" compare run run --format md >compare.md
"$raymoval" plan suite.json --quiet >plan.jsonl
"$raymoval" picture run --kind pr-rr -o run.svg
holds "tables are text" clean run/table.md run/table.tex run/results.csv run.html run.xml compare.md run.svg
holds "the workflow's plan is JSON" python3 -c 'import json; [json.loads(line) for line in open("plan.jsonl")]'
holds "XML is XML" python3 -c 'import xml.dom.minidom as m; m.parse("run.xml"); m.parse("run.svg")'
holds "no table of HTML has a tag of a name" test -z "$(grep -F '<script>alert' run.html run.xml run.svg)"
holds "Markdown has no link or picture of a name" test -z "$(grep -E '(^|[^\\])\[x\]\(' run/table.md compare.md)"
holds "a spreadsheet reads no formula" python3 - run/results.csv <<'PYTHON'
import csv, sys
rows = list(csv.reader(open(sys.argv[1], newline="")))
assert len({len(row) for row in rows}) == 1, "columns"
assert not any(cell[:1] in "=+-@\t\r" and cell[1:2].isalpha() for row in rows for cell in row if cell)
PYTHON
holds "no name was run" test ! -e hacked

echo "hostile: $names names"
finish hostile
