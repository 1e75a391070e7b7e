#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds everything with clang, whose warnings are errors, and runs its static analyser on core,
# datasets, eval and more. CI does not run it: it takes twenty minutes on two cores.
#
#   scripts/clang.sh                 build and analyse (Debian: clang clang-tidy)
#   scripts/clang.sh build           the build only (build/clang)
#   scripts/clang.sh analyse [FILE...]
#                                    the analyser only; default: core, datasets, eval, and the code that
#                                    runs methods in processes
#   scripts/clang.sh tidy [FILE...]  the checks of .clang-tidy; default: all source files
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1

# needs PROGRAM...
needs() {
  local program
  for program in "$@"; do
    command -v "$program" >/dev/null && continue
    echo "clang.sh: $program is missing. Install it: apt-get install clang clang-tidy" >&2
    exit 2
  done
}

build() {
  needs clang++
  cmake --preset clang >/dev/null && cmake --build --preset clang -- -k 0
}

# FloatLoopCounter is disabled: loops over floating-point numbers are intended here.
checks='-*,clang-analyzer-*,-clang-analyzer-security.FloatLoopCounter'

analyse() {
  needs clang++ clang-tidy
  cmake --preset clang >/dev/null || return 2
  local files=("$@")
  if [[ $# -eq 0 ]]; then
    mapfile -t files < <(git ls-files 'core/*.cpp' 'datasets/*.cpp' 'eval/*.cpp' \
      'benchmark/process/*.cpp')
  fi
  printf '%s\0' "${files[@]}" | xargs -0 -P "$(nproc)" -n 4 \
    clang-tidy -p build/clang --quiet --checks="$checks" --warnings-as-errors='*' &&
    echo "clang.sh: ${#files[@]} files, nothing found."
}

tidy() {
  needs clang-tidy
  cmake -S . -B build/tidy -G Ninja -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DRAYMOVAL_BUILD_TESTS=OFF >/dev/null || return 2
  local files=("$@")
  if [[ $# -eq 0 ]]; then
    mapfile -t files < <(git ls-files 'core/*.cpp' 'datasets/*.cpp' 'methods/*.cpp' 'eval/*.cpp' \
      'benchmark/*.cpp' ':!benchmark/kernels')
  fi
  printf '%s\0' "${files[@]}" | xargs -0 -P "$(nproc)" -n 4 clang-tidy -p build/tidy --quiet &&
    echo "clang.sh: ${#files[@]} files, nothing found."
}

case ${1:-} in
  "") build; built=$?; analyse && exit "$built" ;;
  build) build ;;
  analyse) analyse "${@:2}" ;;
  tidy) tidy "${@:2}" ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/clang.sh ;;
  *) echo "clang.sh: '$1' is unknown; expected build, analyse, tidy or nothing." >&2; exit 2 ;;
esac
