#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs clang-tidy with the checks of .clang-tidy. It reads each source file with all its headers,
# which takes about five seconds for a file. CI does not run it.
#
#   scripts/tidy.sh                  all source files of the rooms
#   scripts/tidy.sh FILE...          these files
set -euo pipefail
case ${1:-} in
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
  -*) echo "tidy.sh: '$1' is unknown; expected files or nothing." >&2; exit 2 ;;
esac
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if ! command -v clang-tidy >/dev/null; then
  echo "tidy.sh: clang-tidy is missing. Install it: apt-get install clang-tidy" >&2
  exit 2
fi
cmake -S . -B build/tidy -G Ninja -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DRAYMOVAL_BUILD_TESTS=OFF \
  -DRAYMOVAL_REPORT_3D=OFF >/dev/null

if [[ $# -eq 0 ]]; then
  mapfile -t files < <(git ls-files 'core/*.cpp' 'datasets/*.cpp' 'methods/*.cpp' 'eval/*.cpp' \
    'benchmark/*.cpp' ':!benchmark/kernels')
else
  files=("$@")
fi
printf '%s\0' "${files[@]}" | xargs -0 -P "$(nproc)" -n 4 clang-tidy -p build/tidy --quiet &&
  echo "tidy.sh: ${#files[@]} files, nothing found."
