#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the documentation site: the pages of the repository, the reference of commands and parameters,
# the Python package and the C++ headers (Doxygen), and the report of an example run. Then it checks
# that every link and anchor is valid and that no file is fetched from elsewhere. A warning is an
# error. It takes half a minute.
#
#   scripts/docs.sh                      makes build/site; open build/site/index.html
#   scripts/docs.sh --serve              also serves it at http://localhost:8000 until Ctrl-C
#   scripts/docs.sh --without-cpp        without the pages of the headers
#   scripts/docs.sh --without-report     without the report of an example run
#   scripts/docs.sh --out FOLDER         makes FOLDER/site in place of build/site
#
# It needs Debian's packages mkdocs and mkdocs-material; Doxygen is optional. The program is
# build/release/raymoval, or the path in RAYMOVAL.
set -euo pipefail

serve="" cpp=1 report=1 out=build
while [[ $# -gt 0 ]]; do
  case $1 in
    -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
    --serve) serve=1 ;;
    --without-cpp) cpp="" ;;
    --without-report) report="" ;;
    --out)
      [[ $# -ge 2 ]] || { echo "docs.sh: --out: expected a folder." >&2; exit 2; }
      mkdir -p "$2"
      out=$(readlink -f "$2")
      shift ;;
    *) echo "docs.sh: '$1' is unknown; see --help." >&2; exit 2 ;;
  esac
  shift
done
[[ -z ${RAYMOVAL:-} ]] || RAYMOVAL=$(readlink -f "$RAYMOVAL")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
raymoval=${RAYMOVAL:-build/release/raymoval}
if [[ ! -f $raymoval || ! -x $raymoval || $("$raymoval" --version) != "raymoval "* ]]; then
  echo "docs.sh: $raymoval is no program raymoval; build it, or say where it is with RAYMOVAL." >&2
  exit 2
fi
if ! mkdocs build --help 2>/dev/null | grep -q material; then  # It lists its themes.
  echo "docs.sh: mkdocs or its theme is missing. As root: apt-get install --no-install-recommends mkdocs mkdocs-material" >&2
  exit 2
fi
mkdir -p "$out"
staged=$out/site-src
stage=(python3 -B scripts/site/stage.py --program "$raymoval" --out "$staged")

if [[ -n $cpp && -f build/release/documentation/Doxyfile ]] && command -v doxygen >/dev/null; then
  doxygen build/release/documentation/Doxyfile
  stage+=(--cpp build/release/documentation/html)
elif [[ -n $cpp ]]; then
  echo "docs.sh: without the pages of the headers: doxygen is missing, or build/release was configured without it."
fi
if [[ -n $report ]]; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  "$raymoval" run --sequence street --method raymoval_plus --method raymoval:online --keep-removals \
    --out "$work/street" --quiet >/dev/null
  "$raymoval" report "$work/street" -o "$work/report.html" --points 60000 --quiet >/dev/null
  stage+=(--report "$work/report.html")
fi

"${stage[@]}"
[[ -z $report ]] || rm -rf "$work"  # Before the server takes the place of this script.
mkdocs --quiet build --strict --config-file "$staged/mkdocs.yml"
python3 -B scripts/site/stage.py --check "$out/site"
echo "docs.sh: the site is $out/site/index.html"
[[ -n $serve ]] || exit 0
echo "docs.sh: http://localhost:8000"
exec python3 -m http.server 8000 --bind 127.0.0.1 --directory "$out/site"
