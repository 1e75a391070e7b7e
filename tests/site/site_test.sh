#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The documentation site: every page is in a section, mkdocs has no warning, each link and anchor is
# valid, no file is fetched from elsewhere, generated pages have all of the program's descriptions, and
# a browser shows them well on a phone and in the dark. Without mkdocs only the first is checked, and
# the exit code is 77.
# Usage: site_test.sh PATH/TO/raymoval
set -uo pipefail
raymoval=$(readlink -f "$1")
source_folder=$(readlink -f "$(dirname "${BASH_SOURCE[0]}")/../..")
source "$source_folder/tests/cli/checks.sh"
export PYTHONDONTWRITEBYTECODE=1

stage=(python3 "$source_folder/scripts/site/stage.py" --program "$raymoval" --out "$work/staged")
holds "every page is in a section" "${stage[@]}"
# A page that is in no section, and a section whose page is missing.
in_sections() { (cd "$source_folder/scripts/site" && python3 -c "
import pathlib, reference, stage
pages = stage.pages_of(pathlib.Path('$source_folder')) + list(reference.GENERATED)
$1
try:
    stage.navigation(pages)
except stage.NavigationError as error:
    print(error)") ; }
holds "a page in no section is named" grep -q '^docs/new.md: in no section' <(in_sections "pages.append('docs/new.md')")
holds "a section without its page is named" grep -q 'names docs/clean.md, which' <(in_sections "pages.remove('docs/clean.md')")
holds "a page that may be missing is left out" test -z "$(in_sections "pages = [p for p in pages if p not in stage.IF_THERE]")"

if ! mkdocs build --help 2>/dev/null | grep -q material; then
  finish site || exit 1
  echo "site_test.sh: mkdocs or its theme is missing; the site itself is not made."
  exit 77
fi
RAYMOVAL=$raymoval "$source_folder/scripts/docs.sh" --without-cpp --without-report --out "$work/out" >made.txt 2>&1
holds "the site is made: $(tail -n 5 made.txt)" grep -q ' 0 faults' made.txt
site=$work/out/site
for command in $("$raymoval" --help | sed -n '/^Subcommands:/,/^$/p' | awk 'NR > 1 && NF { print $1 }'); do
  holds "the page of commands has $command" grep -qF "id=\"raymoval-$command\"" "$site/reference/commands.html"
  "$raymoval" "$command" --help | grep -oE '^  (-[a-zA-Z],)?--[a-z-]+' | tr -d ' ' | while read -r option; do
    grep -qF -- "<code>$option" "$site/reference/commands.html" || echo "$command $option"
  done >missing.txt
  holds "the page of commands has its options: $(<missing.txt)" test ! -s missing.txt
done
"$raymoval" list methods | awk '{ print $1 }' | grep -vxE 'noop|remove-all|oracle|external:MANIFEST' >methods.txt
holds "there are methods" test "$(wc -l <methods.txt)" -ge 12
while read -r method; do
  page=$site/reference/parameters/$method.html
  "$raymoval" describe "$method" --markdown | sed -n '/^| -/,$s/^| \([a-z0-9_]*\) .*/\1/p' |
    while read -r name; do grep -qF "<code>$name</code>" "$page" || echo "$name"; done >missing.txt
  holds "there is a page with the parameters of $method: $(<missing.txt)" test -f "$page" -a ! -s missing.txt
  holds "there is a page of $method" test -f "$site/methods/$method/index.html"
done <methods.txt
holds "the search has an index" grep -q minimum_horizontal_range "$site/search/search_index.json"
for name in $(python3 -c "
import ast
tree = ast.parse(open('$source_folder/python/raymoval/__init__.py').read())
print(*[n for n in ast.literal_eval(tree.body[-1].value) if not n.startswith('_')])"); do
  holds "the page of Python has $name" grep -qiF "id=\"$name\"" "$site/reference/python.html"
done

# 77: there is no Chromium.
python3 "$source_folder/tests/site/pages.py" "$site" >looked.txt 2>&1
code=$?
[[ $code -ne 77 ]] || cat looked.txt
holds "the pages look right in Chromium: $(head -n 5 looked.txt)" test "$code" -eq 0 -o "$code" -eq 77

# The check detects planted defects.
check() { python3 "$source_folder/scripts/site/stage.py" --check "$site"; }
page=$site/docs/clean.html
cp "$page" good.html
for fault in 'a href="gone.html":leads nowhere' 'a href="poses.html#gone":there is no such heading' \
  'img src="https://example.org/a.png":from elsewhere'; do
  { cat good.html; echo "<${fault%:*}>"; } >"$page"
  holds "the check finds <${fault%:*}>" grep -q "clean.html.*${fault##*:}" <(check)
done
finish site
