#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks that includes between rooms (top folders), and between the folders of a room, go one way: each
# includes only from itself and from entries before it in the table below. So there is no cycle.
#
#   scripts/check_includes.sh

# A line is a room, or a folder of a room, with its entries from lowest to highest. `.` is the files
# directly in it, and NAME is the files directly in NAME/, or NAME.h and NAME.cpp. Folders below NAME/
# belong to NAME if NAME has its own line, which orders them. Names that `|` joins must not include each
# other, and `*` is all folders that the room's lines do not name, which must not include each other
# either. A file that is not in the table is an error. A room may have several lines.
rooms="core datasets|methods|eval benchmark python"
folders="
core                   . files process scan simd
datasets               records clouds|fields|geometry registration trajectories odometry bags world_axes|deskew ego
datasets               sequence_record sequence reading|settings layout
datasets               semantickitti|dynamicmap|files|bag_scans|truth_map helimos
datasets               simulation layouts sequence_poses open_sequence inspection
datasets/bags          bag|bag_file bag_formats|bag_index|decompress|messages ros1|mcap|ros2 open_bag
datasets/clouds        format las|numpy .
datasets/simulation    shapes world sensor scene|street .
datasets/inspection    evidence checks .
methods                remover calibration method_entry common * registry
methods/common         . patchwork
methods/raymoval       kernels .
methods/raymoval_plus  common terrain evidence objects online .
eval                   . points lattice dynamicmap|erasor|mos protocol_registry columns|comparison|confidence|published
eval/erasor            options|frame maps matching .
benchmark              harness suite result process tables run picture report clean cli cli/commands
benchmark              kernels
benchmark/picture      canvas charts|maps
benchmark/clean        rows outputs .
benchmark/result       . removals|checks
benchmark/run          folder .
benchmark/tables       text .
python                 module
"

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
case ${1:-} in
  "") ;;
  -h | --help) sed -n '3,${/^#/!q;s/^# \{0,1\}//p}' scripts/check_includes.sh; exit 0 ;;
  *) echo "check_includes.sh: '$1' is unknown; expected nothing." >&2; exit 2 ;;
esac

grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"](core|datasets|methods|eval|benchmark|python)/' \
  core datasets methods eval benchmark python --include='*.h' --include='*.cpp' |
  awk -v rooms="$rooms" -v folders="$folders" '
    # Numbers the places of a line from below to above; those side by side have the same number.
    function add_places(room, first, count, words,    i, k, names, n) {
      for (i = first; i <= count; ++i) {
        n = split(words[i], names, "|")
        ++rank[room]
        for (k = 1; k <= n; ++k) level[room, names[k]] = rank[room]
      }
      known[room] = 1
    }
    # The name that a file has in the table of `room` ("" is the house); "" if it has none.
    function place(room, file,    rest, name) {
      rest = room == "" ? file : substr(file, length(room) + 2)
      name = rest
      sub(/\.(h|cpp)$/, "", name)
      if (name !~ /\//) return (room, name) in level ? name : (room, ".") in level ? "." : ""
      sub(/\/[^\/]*$/, "", name)
      if ((room, name) in level) return name
      while (sub(/\/[^\/]*$/, "", name)) {
        if ((room, name) in level && (room == "" ? name : room "/" name) in known) return name
      }
      name = rest
      sub(/\/.*/, "", name)
      if ((room, "*") in level) {
        level[room, name] = level[room, "*"]
        return name
      }
      return ""
    }
    function complain(text) { print "check_includes.sh: " text > "/dev/stderr"; bad = 1 }
    function check(room, from, to, line,    a, b) {
      a = place(room, from); b = place(room, to)
      if (a == "" || b == "") {
        complain((a == "" ? from : to) ": the table at the top does not say where its folder stands")
        return
      }
      if (a == b) {
        # Both below one name: a table of its own may order what is inside.
        a = room == "" ? a : room "/" a
        if (a in known) check(a, from, to, line)
        return
      }
      arrow = (room == "" ? "" : room "/") a " -> " (room == "" ? "" : room "/") b
      if (!(arrow in seen)) { seen[arrow] = 1; ++arrows }
      if (level[room, b] < level[room, a]) return
      if (!(arrow in back)) { back[arrow] = 1; ++backward }
      complain(line ": " a " must not include from " b)
    }
    BEGIN {
      count = split(rooms, words, " ")
      add_places("", 1, count, words)
      lines = split(folders, rows, "\n")
      for (r = 1; r <= lines; ++r) {
        count = split(rows[r], words, " ")
        if (count > 0) add_places(words[1], 2, count, words)
      }
    }
    {
      from = $0; sub(/:.*/, "", from)
      to = $0; sub(/^[^"<]*["<]/, "", to); sub(/[">].*/, "", to)
      where = $0; sub(/:[^:]*$/, "", where)
      if (to != "benchmark/benchmark.h") check("", from, to, where)  # That is Google Benchmark.
    }
    END {
      printf "check_includes.sh: %d arrows between folders, %d of them point the wrong way.\n",
             arrows, backward
      exit bad
    }'
