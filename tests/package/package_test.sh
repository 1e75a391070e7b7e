#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the Debian packages, reads their fields, unpacks each into an empty root and uses it from there.
# Usage: package_test.sh BUILD_FOLDER
set -uo pipefail
build=$(readlink -f "$1")
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
# holds NAME COMMAND...
holds() {
  "${@:2}" >out.txt 2>&1 && return
  failures=$((failures + 1))
  echo "FAILED: $1"
  sed 's/^/  /' out.txt | head -20
}

if ! command -v dpkg-deb >/dev/null || ! command -v dpkg-shlibdeps >/dev/null; then
  echo "package_test.sh: dpkg-deb and dpkg-shlibdeps (package dpkg-dev) are needed." >&2
  exit 1
fi
holds "cpack makes packages" cpack --config "$build/CPackConfig.cmake" -B "$work/packages"
names=(raymoval raymoval-dev)
! grep -q '^RAYMOVAL_PYTHON:BOOL=ON' "$build/CMakeCache.txt" || names=(python3-raymoval "${names[@]}")
made=$(find packages -maxdepth 1 -name '*.deb' -printf '%f\n' 2>/dev/null | sed 's/_.*//' | sort | xargs)
[[ $made == "${names[*]}" ]] ||
  { echo "package_test.sh: expected the packages ${names[*]}, found: $made"; exit 1; }

# field PACKAGE NAME
field() { dpkg-deb --field "packages/$1"_*.deb "$2"; }
# The packages that a field names, without their versions.
names_in() { field "$@" | tr ',' '\n' | sed 's/[(|].*//; s/ //g'; }
version=$("$build/raymoval" --version | grep -oE '[0-9]+\.[0-9]+\.[0-9]+')
for name in "${names[@]}"; do
  holds "$name has the program's version" test "$(field "$name" Version)" = "$version"
  holds "$name has an architecture" test "$(field "$name" Architecture)" = "$(dpkg --print-architecture)"
  holds "$name has the configured maintainer" test "$(field "$name" Maintainer)" = \
    "$(sed -n 's/^RAYMOVAL_PACKAGE_CONTACT:STRING=//p' "$build/CMakeCache.txt")"
  # A package that it names exists: it is installed here, because the build needs it.
  for needed in $(names_in "$name" Depends | grep -vx raymoval); do
    holds "there is a package $needed" dpkg-query --show "$needed"
  done
  holds "$name unpacks into an empty root" dpkg-deb --extract "packages/$name"_*.deb "$name"
  holds "$name has a copyright file" test -s "$name/usr/share/doc/$name/copyright"
  found=$(grep -rlF -e "$source/" -e "$build" "$name")
  holds "no file tells where it was built: $found" test -z "$found"
done
holds "each package has a summary of its own" test -z \
  "$(for name in "${names[@]}"; do field "$name" Description | head -n 1; done | sort | uniq -d)"
found=$(for name in "${names[@]}"; do (cd "$name" && find . -type f); done | sort | uniq -d)
holds "no file is in two packages: $found" test -z "$found"

# Names of libraries have versions that differ from system to system.
for library in fonts-dejavu-core libc6 'libstdc\+\+6' libtbb12 'libembree(3-3|4-4)' libxxhash0 \
  'liboctomap1\.[0-9]+(t64)?' liblzf1; do
  holds "raymoval depends on $library" grep -qxE "$library" <(names_in raymoval Depends)
done
found=$(for kind in Depends Recommends; do names_in raymoval $kind; done | grep -e '-dev$')
holds "raymoval asks for nothing to build with: $found" test -z "$found"
holds "raymoval-dev depends on the same version of raymoval" grep -qF "raymoval (= $version)" \
  <(field raymoval-dev Depends)
holds "raymoval-dev depends on PCL exactly if the program is linked with it" test \
  "$(names_in raymoval-dev Depends | grep -cx libpcl-dev)" = "$(ldd "$build/raymoval" | grep -c libpcl_common)"
# only PACKAGE PATTERN: all files of a package, below /usr, match the pattern.
only() {
  local found
  found=$(cd "$1/usr" && find . -type f | grep -vE "^\./($2)")
  holds "$1 holds nothing else: $found" test -z "$found"
}
only raymoval 'bin/raymoval$|share/'
only raymoval-dev 'include/raymoval/.*\.h$|lib/[a-z_]*\.a$|lib/.*\.cmake$|share/doc/raymoval-dev/'
for path in include/raymoval/methods/remover.h include/raymoval/methods/registry.h \
  include/raymoval/benchmark/harness.h lib/libraymoval_{harness,core,datasets,methods,eval}.a \
  lib/cmake/raymoval/raymovalConfig.cmake; do
  holds "raymoval-dev holds $path" test -s "raymoval-dev/usr/$path"
done
for path in bin/raymoval share/raymoval/suites/quick.json \
  share/raymoval/published/raymoval_table2.json share/raymoval/schema/manifest.schema.json \
  share/doc/raymoval/methods/README.md \
  share/doc/raymoval/methods/raymoval/README.md share/doc/raymoval/datasets/simulation/README.md \
  share/doc/raymoval/results/pictures/maps.png share/doc/raymoval/examples/cpp_method/near_points.cpp \
  share/doc/raymoval/examples/external/voxel_counts/manifest.json \
  share/doc/raymoval/README.md share/doc/raymoval/docs/your-data.md \
  share/man/man1/raymoval.1 share/bash-completion/completions/raymoval \
  share/raymoval/workflow/Snakefile share/raymoval/workflow/slurm/config.yaml \
  share/raymoval/workflow/slurm/raymoval-job-status.sh; do
  holds "raymoval holds $path" test -s "raymoval/usr/$path"
done
# dead_links FOLDER: links of its pages to files that are not there.
dead_links() {
  local page link
  find "$1" -name '*.md' | while read -r page; do
    grep -oE '\]\([^)#: ]+' "$page" | sed 's/^](//' | grep -vx 'https\?' | while read -r link; do
      [[ -e $(dirname "$page")/$link ]] || echo "$page: $link"
    done
  done
}
dead=$(dead_links raymoval/usr/share/doc/raymoval)
holds "its pages have no dead links: $dead" test -z "$dead"
holds "no folder of its documentation is empty" test -z \
  "$(find raymoval/usr/share/doc/raymoval -type d -empty)"

raymoval=$work/raymoval/usr/bin/raymoval
clean=(env -i HOME="$work" PATH=/usr/bin:/bin LC_ALL=C)
holds "it tells its version" "${clean[@]}" "$raymoval" --version
holds "it knows its suites" grep -q '^quick ' <("${clean[@]}" "$raymoval" list suites)
holds "it knows its scenes" grep -q '^town ' <("${clean[@]}" "$raymoval" list scenes)
if command -v snakemake >/dev/null; then
  mkdir elsewhere
  (cd elsewhere && "${clean[@]}" snakemake -s "$work/raymoval/usr/share/raymoval/workflow/Snakefile" \
    --cores 1 --dry-run --printshellcmds --config suite=quick out=run) >workflow.txt 2>&1
  holds "its workflow finds its program" grep -q "^$raymoval plan quick" workflow.txt
else
  echo "package_test.sh: snakemake is missing; the packaged workflow is not tried."
fi
holds "it runs" "${clean[@]}" "$raymoval" run --sequence street --frames 0:5 --quiet \
  --method raymoval:online --out run
holds "it scores" grep -q '^street,raymoval,online,erasor,ok,' run/results.csv
"${clean[@]}" "$raymoval" table run --with-published >published.txt 2>&1
holds "it has the published tables" grep -q "no paper has numbers for it by erasor" published.txt
holds "it cleans a map" "${clean[@]}" "$raymoval" clean street --frames 0:5 --quiet -o map.pcd

if [[ -d python3-raymoval ]]; then
  for needed in python3 python3-numpy libc6 libtbb12 'libembree(3-3|4-4)'; do
    holds "python3-raymoval depends on $needed" grep -qxE "$needed" <(names_in python3-raymoval Depends)
  done
  only python3-raymoval 'lib/python3/dist-packages/raymoval/|share/doc/python3-raymoval/'
  holds "it is imported" "${clean[@]}" \
    PYTHONPATH="$work/python3-raymoval/usr/lib/python3/dist-packages" /usr/bin/python3 -B -c \
    'import raymoval; assert len(raymoval.open("street", frames="0:3", progress=False)) == 4'
fi

for name in "${names[@]}"; do
  echo "$name: $(du -h "packages/$name"_*.deb | cut -f1), depends on $(field "$name" Depends)"
done
[[ $failures -eq 0 ]]
