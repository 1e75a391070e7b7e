#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the packages of Debian or Ubuntu that raymoval is built with (docs/platforms.md: which were
# tried). Only what is missing is installed; a second run changes nothing. On another system it says
# what is missing there.
#
#   scripts/install_dependencies.sh            what building and running needs
#   scripts/install_dependencies.sh --python   also what the Python package is built with
#   scripts/install_dependencies.sh --tests    also that, and what the tests and the Snakemake workflow need
#                                              (200 MB to fetch, 1.3 GB installed: Debian's snakemake
#                                              depends on the clients of all clouds, tables are compiled
#                                              with LaTeX, reports are opened in Chromium,
#                                              and mkdocs makes the documentation site)
set -euo pipefail

packages=(
  cmake ninja-build g++ pkg-config libeigen3-dev libpcl-dev liboctomap-dev nlohmann-json3-dev
  catch2 libbenchmark-dev libcli11-dev libtbb-dev robin-map-dev libnanoflann-dev libhwy-dev
  libembree-dev libfmt-dev librapidcheck-dev libxxhash-dev liblzf-dev zlib1g-dev libbz2-dev
  liblz4-dev libzstd-dev libsqlite3-dev libcairo2-dev fonts-dejavu-core esbuild
)
python=(pybind11-dev python3-dev python3-numpy python3-pip python3-venv)
case ${1:-} in
  "") ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
  --python) packages+=("${python[@]}") ;;
  --tests) packages+=("${python[@]}" mypy snakemake python3-jsonschema python3-yaml dpkg-dev file
    texlive-latex-base texlive-latex-recommended chromium doxygen mkdocs mkdocs-material) ;;
  *) echo "install_dependencies.sh: '$1' is unknown; expected nothing, --python or --tests." >&2
     exit 2 ;;
esac
# npm fetches three.js. One that did not come from Debian will do, and would be in Debian's way.
command -v npm >/dev/null || packages+=(npm)

# Reports are without their 3-D view, or a test is left out, where a system has no package of these.
optional=" esbuild npm chromium snakemake mypy doxygen texlive-latex-base texlive-latex-recommended "

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "install_dependencies.sh: this is no Debian or Ubuntu (no apt-get or no dpkg-query), so nothing is installed." >&2
  if ! command -v cmake >/dev/null; then
    echo "There is no cmake to ask what is missing. Install it, and what this system calls: ${packages[*]}" >&2
    exit 2
  fi
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  if cmake -S "$(dirname "${BASH_SOURCE[0]}")/.." -B "$work" -DRAYMOVAL_REPORT_3D=OFF >"$work/log" 2>&1; then
    echo "CMake finds all that it needs here."
    exit 0
  fi
  sed -n '/raymoval cannot be built here/,/^ *On Debian and Ubuntu/p' "$work/log" | grep -v 'On Debian and Ubuntu' >"$work/lacks" || true
  [[ -s $work/lacks ]] || tail -n 15 "$work/log" >"$work/lacks"
  cat "$work/lacks" >&2
  exit 2
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "install_dependencies.sh: all ${#packages[@]} packages are there."
  exit 0
fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "install_dependencies.sh: missing: ${missing[*]}" >&2
    echo "Installing them needs root, and there is no sudo. Run as root:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 2
  fi
  as_root=(sudo)
fi

scratch=$(mktemp -d)
manual_index=/var/lib/man-db/auto-update  # Says that new packages are indexed; empty.
index_is_off=
clean_up() {
  [[ -z $index_is_off ]] || "${as_root[@]}" touch "$manual_index"
  rm -rf "$scratch"
}
trap clean_up EXIT

# make_stand_in: an empty package in place of clients of clouds, $scratch/stand_in.deb.
make_stand_in() {
  mkdir -p "$scratch/package/DEBIAN"
  printf '%s\n' "Package: raymoval-without-clouds" "Version: 1" "Architecture: all" \
    "Maintainer: raymoval <raymoval@localhost>" \
    "Provides: python3-azure, python3-azure-storage, python3-boto3" \
    "Description: stands for clients of clouds that no test needs" >"$scratch/package/DEBIAN/control"
  dpkg-deb --build --root-owner-group "$scratch/package" "$scratch/stand_in.deb" >/dev/null
  chmod -R a+rX "$scratch"  # apt reads it as a user of its own.
}

# On a machine that is thrown away nobody waits for the disk after each file, as dpkg does, nor needs an
# index of manual pages, or the clients of clouds that Debian's snakemake depends on: 600 MB, and Azure's
# alone are compiled for most of a minute.
extra=()
if [[ ${CI:-} == true ]]; then
  extra+=(-o Dpkg::Options::=--force-unsafe-io)
  if [[ -e $manual_index ]]; then
    index_is_off=yes
    "${as_root[@]}" rm -f "$manual_index"
  fi
  if [[ " ${missing[*]} " == *" snakemake "* ]]; then
    make_stand_in
    extra+=("$scratch/stand_in.deb")
  fi
fi

# The package lists are fetched only if apt does not know the packages from earlier.
if ! apt-cache show "${missing[@]}" >/dev/null 2>&1; then
  echo "install_dependencies.sh: fetching the package lists"
  "${as_root[@]}" apt-get update
fi
unknown=()
left_out=()
known=()
for package in "${missing[@]}"; do
  if apt-cache show "$package" >/dev/null 2>&1; then
    known+=("$package")
  elif [[ $optional == *" $package "* ]]; then
    left_out+=("$package")
  else
    unknown+=("$package")
  fi
done
if [[ ${#unknown[@]} -gt 0 ]]; then
  echo "install_dependencies.sh: this system has no package ${unknown[*]}, which raymoval needs. docs/platforms.md says which systems have all." >&2
  exit 2
fi
[[ ${#left_out[@]} -eq 0 ]] ||
  echo "install_dependencies.sh: this system has no package ${left_out[*]}; reports may be without their 3-D view, and some tests are left out."
if [[ ${#known[@]} -eq 0 ]]; then
  exit 0
fi
echo "install_dependencies.sh: installing ${known[*]}"
install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes
         --no-install-recommends "${extra[@]}" "${known[@]}")
# Lists from earlier may name files that are gone.
if ! "${install[@]}"; then
  echo "install_dependencies.sh: fetching the package lists"
  "${as_root[@]}" apt-get update
  "${install[@]}"
fi
echo "install_dependencies.sh: done."
