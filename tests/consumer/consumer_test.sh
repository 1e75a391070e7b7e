#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the library, builds programs against it, and uses a method of one's own by the commands of
# raymoval. Usage: consumer_test.sh BUILD_FOLDER
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
  sed 's/^/  /' out.txt | tail -20
}

holds "it installs" cmake --install "$build" --prefix "$work/installed"
include=$work/installed/include/raymoval
holds "no file tells where it was built" test -z "$(grep -rlF -e "$source/" -e "$build/" installed)"
holds "the installed program runs" installed/bin/raymoval list methods

# Each header can be included alone, and none includes headers that only the library's sources need.
# Eigen is precompiled for headers that include it, which -M shows.
flags=(-std=c++20 -w -x c++ -I "$include" $(pkg-config --cflags eigen3))
headers() { (cd "$include" && find . -name '*.h' | sed 's|^\./||' | sort); }
holds "headers are installed" test "$(headers | wc -l)" -gt 20
echo '#include <Eigen/Core>' >eigen.h
holds "Eigen is compiled" g++ "${flags[@]/#c++/c++-header}" eigen.h -o eigen.h.gch
# compiles HEADER FLAG...
compiles() {
  local first=()
  ! g++ -M "${@:2}" - <<<"#include \"$1\"" | grep -q Eigen/Core || first=(-include eigen.h)
  g++ -fsyntax-only "${first[@]}" "${@:2}" - <<<"#include \"$1\""
}
export -f compiles
alone=$(headers | xargs -P 2 -I {} bash -c 'compiles "$@" >/dev/null 2>&1 || echo "$1"' - {} "${flags[@]}")
holds "each header compiles alone, but not: $alone" test -z "$alone"
headers | sed 's/.*/#include "&"/' >all.cpp
holds "headers reach neither CLI11, PCL, Highway nor all of nlohmann/json" test -z \
  "$(g++ -M "${flags[@]}" all.cpp | grep -E 'nlohmann/json\.hpp|/CLI/|/pcl|/hwy/')"

holds "the consumers are configured" cmake -G Ninja -S "$source/tests/consumer" -B consumers \
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_PREFIX_PATH="$work/installed"
holds "the consumers are built" cmake --build consumers
holds "the methods run without the harness" consumers/methods_only
holds "a program of its own runs and scores a method" consumers/library_use

# The example: a method outside of the repository has every command, in processes of its own.
near=$work/consumers/near_points/near_points
holds "the example is short" test "$(wc -l <"$source/examples/cpp_method/near_points.cpp")" -le 60
holds "it is listed" grep -q '^near ' <("$near" list methods)
holds "it is described" grep -q 'limit = 10 m .* chosen here' <("$near" describe near)
holds "help has its name" grep -qF 'near_points run --sequence' <("$near" help run)
holds "and no other" test "$(for command in "" run clean table; do "$near" $command --help; done | grep -cE 'raymoval (run|clean|table)')" -eq 0
holds "it runs beside others" "$near" run --sequence street --frames 0:4 --quiet --method near \
  --method raymoval:online --set near.limit=8 --keep-removals --out run
holds "it is scored" grep -qE '^street,near,default,erasor,ok,[0-9]+\.[0-9]+' run/results.csv
holds "the other is scored" grep -q '^street,raymoval,online,erasor,ok,' run/results.csv
holds "its parameter is kept" grep -q '"limit": 8' run/cells/street/near-default_/cell.json
holds "it runs again with the same answers" "$near" run --sequence street --frames 0:4 --quiet \
  --method near --method raymoval:online --set near.limit=8 --out again
holds "runs are compared" "$near" compare again run
holds "it is reported" "$near" report run -o run.html --quiet
holds "the report has it" grep -q 'near' run.html
holds "it cleans" "$near" clean street --frames 0:4 --method near --quiet -o map.pcd
holds "the map is there" test -s map.pcd

echo "consumer: $(headers | wc -l) headers, $(du -sh installed/lib | cut -f1) of libraries"
[[ $failures -eq 0 ]]
