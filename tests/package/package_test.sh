#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the Debian package, reads its fields, unpacks it into an empty root and uses it from there.
# Usage: package_test.sh BUILD_FOLDER 1|0
# 1 where the program has PCL.
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
holds "cpack makes a package" cpack --config "$build/CPackConfig.cmake" -B "$work/packages"
package=$(find packages -maxdepth 1 -name 'raymoval_*.deb' 2>/dev/null)
[[ -f $package ]] || { echo "package_test.sh: expected one package, found: $package"; exit 1; }

field() { dpkg-deb --field "$package" "$1"; }
# The packages a field names, without their versions.
names_in() { field "$1" | tr ',' '\n' | sed 's/[(|].*//; s/ //g'; }
version=$("$build/raymoval" --version | grep -oE '[0-9]+\.[0-9]+\.[0-9]+')
holds "its name" test "$(field Package)" = raymoval
holds "its version is the program's" test "$(field Version)" = "$version"
holds "its architecture" test "$(field Architecture)" = "$(dpkg --print-architecture)"
holds "it says what it is" test -n "$(field Description)"
holds "its maintainer is who was configured" test "$(field Maintainer)" = \
  "$(sed -n 's/^RAYMOVAL_PACKAGE_CONTACT:STRING=//p' "$build/CMakeCache.txt")"
# Their names have versions that differ from system to system.
libraries=(libc6 'libstdc\+\+6' libtbb12 'libembree(3-3|4-4)' libxxhash0 'liboctomap1\.[0-9]+(t64)?' liblzf1)
if [[ $2 == 1 ]]; then
  libraries+=('libpcl-common1\.[0-9]+(t64)?' 'libpcl-sample-consensus1\.[0-9]+(t64)?')
else
  holds "nothing of PCL is needed" test -z "$(names_in Depends | grep pcl)$(names_in Recommends | grep pcl)"
fi
for library in "${libraries[@]}"; do
  holds "it depends on $library" grep -qxE "$library" <(names_in Depends)
done
# What it names can be had: by name it is installed here, since it was built with it.
for needed in $(names_in Depends) $(names_in Recommends); do
  holds "there is a package $needed" dpkg-query --show "$needed"
done

mkdir root
holds "it unpacks into an empty root" dpkg-deb --extract "$package" root
for path in bin/raymoval include/raymoval/methods/remover.h include/raymoval/methods/registry.h \
  include/raymoval/benchmark/harness.h lib/libraymoval_harness.a \
  lib/libraymoval_core.a lib/libraymoval_datasets.a lib/libraymoval_methods.a \
  lib/libraymoval_eval.a lib/cmake/raymoval/raymovalConfig.cmake \
  share/raymoval/suites/quick.json share/raymoval/published/raymoval_table2.json \
  share/raymoval/schema/manifest.schema.json share/doc/raymoval/copyright \
  share/doc/raymoval/methods/README.md \
  share/doc/raymoval/methods/raymoval/README.md share/doc/raymoval/datasets/simulation/README.md \
  share/doc/raymoval/results/pictures/maps.png share/doc/raymoval/examples/cpp_method/near_points.cpp \
  share/doc/raymoval/examples/external/voxel_counts/manifest.json \
  share/doc/raymoval/README.md share/doc/raymoval/docs/your-data.md \
  share/man/man1/raymoval.1 share/bash-completion/completions/raymoval \
  share/zsh/vendor-completions/_raymoval share/fish/vendor_completions.d/raymoval.fish \
  share/raymoval/workflow/Snakefile share/raymoval/workflow/slurm/config.yaml \
  share/raymoval/workflow/slurm/raymoval-job-status.sh; do
  holds "it holds $path" test -s "root/usr/$path"
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
dead=$(dead_links root/usr/share/doc/raymoval)
holds "its pages have no dead links: $dead" test -z "$dead"
holds "no folder of its documentation is empty" test -z \
  "$(find root/usr/share/doc/raymoval -type d -empty)"
found=$(grep -rlF -e "$source/" -e "$build" root)
holds "no file tells where it was built: $found" test -z "$found"

raymoval=$work/root/usr/bin/raymoval
clean=(env -i HOME="$work" PATH=/usr/bin:/bin LC_ALL=C)
holds "it tells its version" "${clean[@]}" "$raymoval" --version
holds "it knows its suites" grep -q '^quick ' <("${clean[@]}" "$raymoval" list suites)
holds "it knows its scenes" grep -q '^town ' <("${clean[@]}" "$raymoval" list scenes)
holds "its manual page is the program's" diff root/usr/share/man/man1/raymoval.1 \
  <("${clean[@]}" "$raymoval" help --man)
for shell in bash:bash-completion/completions/raymoval zsh:zsh/vendor-completions/_raymoval \
  fish:fish/vendor_completions.d/raymoval.fish; do
  holds "its completion for ${shell%%:*} is the program's" diff "root/usr/share/${shell#*:}" \
    <("${clean[@]}" "$raymoval" completion "${shell%%:*}")
done
if command -v snakemake >/dev/null; then
  mkdir elsewhere
  (cd elsewhere && "${clean[@]}" snakemake -s "$work/root/usr/share/raymoval/workflow/Snakefile" \
    --cores 1 --dry-run --printshellcmds --config suite=quick out=run) >workflow.txt 2>&1
  holds "its workflow finds its program" grep -q "^$raymoval plan quick" workflow.txt
else
  echo "package_test.sh: snakemake is missing; the packaged workflow is not tried."
fi
holds "it runs" "${clean[@]}" "$raymoval" run --sequence street --frames 0:5 --quiet \
  --method raymoval:online --out run
holds "it scores" grep -q '^street,raymoval,online,erasor,ok,' run/results.csv
holds "it has the published tables" "${clean[@]}" "$raymoval" table run --with-published
holds "it cleans a map" "${clean[@]}" "$raymoval" clean street --frames 0:5 --quiet -o map.pcd

# The Python package, if the build has it.
python_package=$(find packages -maxdepth 1 -name 'python3-raymoval_*.deb')
has_python=$(grep -c '^RAYMOVAL_PYTHON:BOOL=ON' "$build/CMakeCache.txt")
holds "there is a Python package exactly if the build has one: $python_package" \
  test "$has_python" -eq "$(grep -c . <<<"$python_package")"
if [[ -f $python_package ]]; then
  program_package=$package
  package=$python_package
  holds "the Python package's name" test "$(field Package)" = python3-raymoval
  holds "the Python package's version" test "$(field Version)" = "$version"
  for needed in python3 python3-numpy libc6 libtbb12 'libembree(3-3|4-4)'; do
    holds "the Python package depends on $needed" grep -qxE "$needed" <(names_in Depends)
  done
  mkdir python_root
  holds "the Python package unpacks" dpkg-deb --extract "$package" python_root
  found=$(cd python_root && find . -type f | grep -v '^./usr/lib/python3/dist-packages/raymoval/')
  holds "it holds nothing else: $found" test -z "$found"
  found=$(cd root && find . -path '*python3*')
  holds "the other package holds nothing of it: $found" test -z "$found"
  found=$(grep -rlF -e "$source/" -e "$build" python_root)
  holds "no file of it tells where it was built: $found" test -z "$found"
  holds "it is imported" "${clean[@]}" \
    PYTHONPATH="$work/python_root/usr/lib/python3/dist-packages" /usr/bin/python3 -B -c \
    'import raymoval; assert len(raymoval.open("street", frames="0:3", progress=False)) == 4'
  echo "Python package: $(du -h "$package" | cut -f1), depends on $(field Depends)"
  package=$program_package
fi

echo "package: $(du -h "$package" | cut -f1), depends on $(field Depends)"
[[ $failures -eq 0 ]]
