#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the packages of Debian or Ubuntu that raymoval is built with (tested systems:
# docs/platforms.md). Only missing packages are installed; a second run changes nothing. On another
# system it lists the missing packages.
#
#   scripts/install_dependencies.sh            packages for building and running
#   scripts/install_dependencies.sh --tests    also packages for scripts/test.sh
#   scripts/install_dependencies.sh --python   also packages for building the Python package
#   scripts/install_dependencies.sh --all      also packages for scripts/test.sh --all: LaTeX, Chromium, MkDocs,
#                                              Snakemake and more
#   scripts/install_dependencies.sh --without-pcl ...
#                                              leaves out PCL: 138 MB to fetch and 0.56 GB installed in place of
#                                              630 MB and 2.8 GB; `octomap:ground` will be missing
#   RAYMOVAL_PCL=OFF                           the same, for scripts that call this one
set -euo pipefail

packages=(
  cmake ninja-build g++ pkg-config libeigen3-dev liboctomap-dev nlohmann-json3-dev
  catch2 librapidcheck-dev libbenchmark-dev libcli11-dev libtbb-dev robin-map-dev libnanoflann-dev libhwy-dev
  libembree-dev libfmt-dev libxxhash-dev liblzf-dev zlib1g-dev libbz2-dev
  liblz4-dev libzstd-dev libsqlite3-dev libyaml-cpp-dev libzip-dev libcairo2-dev fonts-dejavu-core
)
tests=(clang-format git procps python3-numpy python3-yaml python3-jsonschema)
python=(pybind11-dev python3-dev python3-numpy python3-pip python3-venv)
extra=(gcovr mypy snakemake dpkg-dev file texlive-latex-base texlive-latex-recommended chromium
  doxygen mkdocs mkdocs-material)
pcl=(libpcl-dev)
[[ ${RAYMOVAL_PCL:-} != OFF ]] || pcl=()
for argument in "$@"; do
  case $argument in
    -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
    --without-pcl) pcl=() ;;
    --tests) packages+=("${tests[@]}") ;;
    --python) packages+=("${python[@]}") ;;
    --all) packages+=("${tests[@]}" "${python[@]}" "${extra[@]}") ;;
    *) echo "install_dependencies.sh: '$argument' is unknown; expected --tests, --python, --all or --without-pcl." >&2
       exit 2 ;;
  esac
done
packages+=(${pcl[@]+"${pcl[@]}"})

# A test is left out where a system has no package of these.
optional=" chromium snakemake mypy doxygen texlive-latex-base texlive-latex-recommended "

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "install_dependencies.sh: this is no Debian or Ubuntu (no apt-get or no dpkg-query), so nothing is installed." >&2
  if ! command -v cmake >/dev/null; then
    echo "There is no cmake to ask what is missing. Install it, and what this system calls: ${packages[*]}" >&2
    exit 2
  fi
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  if cmake -S "$(dirname "${BASH_SOURCE[0]}")/.." -B "$work" \
      -DRAYMOVAL_PCL="$([[ ${#pcl[@]} -gt 0 ]] && echo ON || echo OFF)" >"$work/log" 2>&1; then
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

# The package lists are fetched only if apt does not have the packages in its lists. Each package is queried
# separately: apt-cache succeeds if it finds one of several, and takes g++ for a pattern.
known_to_apt() { apt-cache show --no-all-versions "${1//+/\\+}" >/dev/null 2>&1; }
for package in "${missing[@]}"; do
  known_to_apt "$package" || [[ $optional == *" $package "* ]] || lists=old
done
if [[ -n ${lists:-} ]]; then
  echo "install_dependencies.sh: fetching the package lists"
  "${as_root[@]}" apt-get update
fi
unknown=()
left_out=()
known=()
for package in "${missing[@]}"; do
  if known_to_apt "$package"; then
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
         --no-install-recommends "${known[@]}")
# Lists from earlier may name files that are gone.
if ! "${install[@]}"; then
  echo "install_dependencies.sh: fetching the package lists"
  "${as_root[@]}" apt-get update
  "${install[@]}"
fi
echo "install_dependencies.sh: done."
