#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# table.tex must compile unchanged in a minimal document, within the page.
# Usage: latex_test.sh PATH/TO/raymoval; exit code 77: there is no pdflatex.
set -uo pipefail
if ! command -v pdflatex >/dev/null; then
  echo "latex_test.sh: no pdflatex; run scripts/install_dependencies.sh --all" >&2
  exit 77
fi
raymoval=$(readlink -f "$1")
source "$(dirname "${BASH_SOURCE[0]}")/../cli/checks.sh"

# compiles FILE.tex: in an article of one column and of two, without an error, and with nothing that
# sticks out by more than a letter.
compiles() {
  local columns document
  for columns in onecolumn twocolumn; do
    document=${1%.tex}_$columns
    printf '%s\n' "\\documentclass[$columns]{article}" '\usepackage{booktabs,graphicx}' '\begin{document}' \
      "\\input{$1}" '\end{document}' >"$document.tex"
    holds "$1 compiles in $columns" pdflatex -interaction=nonstopmode -halt-on-error "$document.tex"
    holds "$1 fits the page in $columns" test -z "$(grep -E '^Overfull .hbox \(([6-9]|[0-9]{2,})' \
      "$document.log"; grep -E 'Float too large|undefined' "$document.log")"
  done
}

# The long way round: many methods, a sweep, odd names, a cell that fails with a long reason.
cat >suite.json <<'JSON'
{
  "name": "odd & ends_100%",
  "sequences": [
    { "path": "street", "name": "[a]_b & 50% #1 {x} ~^ <>| --", "frames": "0:4" },
    { "path": "street", "name": "straße 道", "frames": "0:3" }
  ],
  "methods": [
    "raymoval:online", "octomap:kth", "removert:rm3", "dufomap:offline", "erasor:general",
    { "method": "raymoval:offline", "set": { "tau1": { "sweep": [0.1, 0.2] } } },
    { "method": "external:MANIFEST", "as": "fails_with_a_long_reason" }
  ],
  "protocols": ["erasor", "dynamicmap"]
}
JSON
cat >fails.json <<'JSON'
{ "name": "fails", "sentence": "Fails.", "source": "test", "version": "1", "online": false,
  "command": ["/bin/sh", "-c", "echo /a/rather/long_path/that/nobody/can/break/into/lines/because/it/has/no/blanks >&2; exit 3"] }
JSON
sed -i "s|MANIFEST|$work/fails.json|" suite.json
"$raymoval" run suite.json --quiet --out run >out.txt 2>err.txt
holds "the run made its table" test -s run/table.tex
holds "the failed cell is in it" grep -q 'fails' run/table.tex
cp run/table.tex run.tex
compiles run.tex
"$raymoval" table run --format tex --what all >all.tex
compiles all.tex
make_drive 05 2350 2670 2
"$raymoval" run 05 --method raymoval:online --quiet --out segment >out.txt 2>err.txt
"$raymoval" table segment --with-published --format tex --what accuracy,published >published.tex
holds "papers' rows are in it" grep -qF '(published)' published.tex
compiles published.tex
"$raymoval" table run --what columns,losses,intervals --format tex >columns.tex
compiles columns.tex
"$raymoval" table run --layout paper --format tex >paper.tex
compiles paper.tex
# One method's rates fit a column: a plain table.
"$raymoval" table run --only '*/raymoval*' --rates PR,RR,F1 --format tex >narrow.tex
compiles narrow.tex
holds "a narrow table stays in its column" grep -qF '\begin{table}' narrow.tex
holds "the best is bold" grep -qF '\textbf{' run.tex
holds "the second is underlined" grep -qF '\underline{' run.tex
finish latex
