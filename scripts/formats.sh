#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Reads clouds, poses and recordings that other programs wrote and has them read ours
# (tests/formats): NumPy, PCL's converters, Open3D, ROS's rosbag and rostopic, npm's @mcap/core and
# @foxglove/rosmsg2-serialization, sqlite3 and plain Python, a line for each format and variant. Not
# a part of ctest. Debian's packages that are missing are installed (python3-numpy, pcl-tools,
# python3-open3d, python3-rosbag and what it needs: 50 MB), npm's are put into BUILD.
#
#   scripts/formats.sh [BUILD] [TABLE...]    BUILD is a configured build folder (default:
#                                            build/release), TABLE clouds, poses or recordings
#                                            (default: all of them)
set -euo pipefail
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
  -*) echo "formats.sh: '$1' is unknown; see --help." >&2; exit 2 ;;
esac
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=${1:-build/release}
tables=("${@:2}")
[[ ${#tables[@]} -gt 0 ]] || tables=(clouds poses recordings)
for table in "${tables[@]}"; do
  case $table in
    clouds | poses | recordings) ;;
    *) echo "formats.sh: '$table' is no table; see --help." >&2; exit 2 ;;
  esac
done
if [[ ! -f $build/CMakeCache.txt ]]; then
  echo "formats.sh: $build is no configured build folder; run cmake --preset release first." >&2
  exit 2
fi
missing=()
for package in python3-numpy pcl-tools python3-open3d python3-rosbag python3-rostopic \
  python3-sensor-msgs python3-nav-msgs python3-tf2-msgs nodejs npm lz4 zstd; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  # Node.js and npm need not come from Debian.
  # Those that are programs need not come from Debian.
  [[ $status == installed ]] || command -v "${package/nodejs/node}" >/dev/null || missing+=("$package")
done
if [[ ${#missing[@]} -gt 0 ]]; then
  as_root=()
  [[ $(id -u) -eq 0 ]] || as_root=(sudo)
  # Without one of them its lines say that it was not there.
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes \
    --no-install-recommends "${missing[@]}" >&2 || true
fi
npm=$build/formats_npm
if [[ ! -d $npm/node_modules/@mcap/core ]]; then
  npm install --prefix "$npm" --no-save --no-audit --no-fund @mcap/core @foxglove/rosmsg \
    @foxglove/rosmsg2-serialization >&2 || true
fi
export NODE_PATH=$PWD/$npm/node_modules
[[ $npm != /* ]] || export NODE_PATH=$npm/node_modules
cmake --build "$build" --target raymoval_formats >&2
failed=0
for table in "${tables[@]}"; do
  # Debian's Python has the packages; another one may come first in the path.
  /usr/bin/python3 -B "tests/formats/$table.py" "$build/raymoval_formats" || failed=1
done
exit $failed
