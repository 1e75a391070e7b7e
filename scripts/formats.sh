#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Reads clouds that other programs wrote and has them read ours (tests/formats): NumPy, PCL's
# converters, Open3D and plain Python, a line for each format and variant. Not a part of ctest.
# Packages that are missing are installed (python3-numpy, pcl-tools, python3-open3d: 40 MB).
#
#   scripts/formats.sh [BUILD]     BUILD is a configured build folder (default: build/release)
set -euo pipefail
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
  -*) echo "formats.sh: '$1' is unknown; see --help." >&2; exit 2 ;;
esac
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${1:-build/release}
if [[ ! -f $build/CMakeCache.txt ]]; then
  echo "formats.sh: $build is no configured build folder; run cmake --preset release first." >&2
  exit 2
fi
missing=()
for package in python3-numpy pcl-tools python3-open3d; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if [[ ${#missing[@]} -gt 0 ]]; then
  as_root=()
  [[ $(id -u) -eq 0 ]] || as_root=(sudo)
  # Without one of them its lines say that it was not there.
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes \
    --no-install-recommends "${missing[@]}" >&2 || true
fi
cmake --build "$build" --target raymoval_formats >&2
# Debian's Python has the packages; another one may come first in the path.
exec /usr/bin/python3 tests/formats/formats.py "$build/raymoval_formats"
