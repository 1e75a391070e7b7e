// SPDX-License-Identifier: MIT
#include <cstdint>
#include <map>

#include "core/error.h"
#include "core/text.h"
#include "datasets/trajectories/pose_columns.h"
#include "datasets/trajectories/pose_format.h"

namespace raymoval::pose_formats {
namespace {

constexpr std::string_view kVertex = "VERTEX_SE3:QUAT";

bool is_g2o_word(std::string_view word) {
  return word.starts_with("VERTEX_") || word.starts_with("EDGE_") || word == "FIX" ||
         word.starts_with("PARAMS_");
}

Match match_g2o(const PoseText& text) {
  const auto& words = text.first().words;
  return !words.empty() && is_g2o_word(words.front()) ? Match::kYes : Match::kNo;
}

PoseFile read_g2o(const PoseText& text) {
  // Tag, id, x y z qx qy qz qw.
  PoseColumns columns;
  columns.count = 9;
  columns.position = {2, 3, 4};
  columns.turn = {5, 6, 7, 8};
  std::map<std::uint64_t, PoseFile::Row> vertices;
  text.for_each_row([&](const TextRow& row) {
    if (row.words.front() != kVertex) return;
    const std::string where = text.place(row.line);
    if (row.words.size() != columns.count) {
      throw DataError(where + ": " + std::to_string(row.words.size()) +
                      " words; expected 9: VERTEX_SE3:QUAT id x y z qx qy qz qw.");
    }
    const auto id = parse_number<std::uint64_t>(row.words[1]);
    if (!id) throw DataError(where + ": the id of a vertex is a whole number from 0 on.");
    std::vector<double> numbers(columns.count, 0.0);
    for (std::size_t i = 2; i < columns.count; ++i) numbers[i] = text.number(row, i);
    PoseFile::Row pose;
    pose.line = row.line;
    pose.matrix = pose_matrix(numbers, columns, where);
    if (!vertices.emplace(*id, pose).second) {
      throw DataError(where + ": there is a vertex " + std::to_string(*id) + " above already.");
    }
  });
  PoseFile file;
  file.path = text.path();
  file.has_quaternions = true;
  for (const auto& [id, pose] : vertices) file.rows.push_back(pose);
  if (file.rows.empty()) {
    throw DataError(text.path().string() +
                    ": has no vertex VERTEX_SE3:QUAT (id x y z qx qy qz "
                    "qw); poses in the plane are not read.");
  }
  file.notes.push_back(text.path().string() +
                       ": a g2o file has no times. Its poses belong to the scans by their order, "
                       "which is that of the ids.");
  return file;
}

}  // namespace

TextFormat g2o_format() {
  return {{"g2o", "vertices VERTEX_SE3:QUAT of a pose graph, in the order of their ids; no times"},
          match_g2o,
          read_g2o};
}

}  // namespace raymoval::pose_formats
