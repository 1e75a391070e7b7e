// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/numpy/npy_head.h"
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
    const PoseFile::Row pose{.matrix = pose_matrix(numbers, columns, where), .line = row.line};
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

namespace {

constexpr std::string_view kNumpyMagic = "\x93NUMPY";

double number_at(const char* bytes, std::size_t size, bool big_endian) {
  char place[8];
  for (std::size_t i = 0; i < size; ++i) place[i] = bytes[big_endian ? size - 1 - i : i];
  if (size == 4) {
    float number;
    std::memcpy(&number, place, 4);
    return static_cast<double>(number);
  }
  double number;
  std::memcpy(&number, place, 8);
  return number;
}

/// The number of values per pose in an array N x 4 x 4, N x 3 x 4, N x 12 or N x 16.
/// @throws DataError for arrays of another shape or type
std::size_t numbers_of_pose(const NpyHead& head, const std::string& where) {
  const std::vector<std::uint64_t>& shape = head.shape;
  const bool plane = shape.size() == 2 && (shape[1] == 12 || shape[1] == 16);
  const bool matrices = shape.size() == 3 && (shape[1] == 3 || shape[1] == 4) && shape[2] == 4;
  if (!plane && !matrices) {
    throw DataError(where + ": is an array of " + head.shape_text() +
                    "; expected N x 4 x 4 or N x 3 x 4 matrices.");
  }
  const bool real = !head.type.structured && head.type.fields.front().field.type == 'F';
  if (!real || head.type.fields.front().field.count != 1) {
    throw DataError(where + ": does not hold real numbers; expected float64 or float32.");
  }
  return static_cast<std::size_t>(plane ? shape[1] : 4 * shape[1]);
}

/// The index of number `k` of pose `i` in the array.
std::size_t place_of(const NpyHead& head, std::size_t i, std::size_t k, std::size_t numbers) {
  if (!head.by_columns) return i * numbers + k;
  // In Fortran order the first index runs fastest, then the row of a matrix, then its column.
  const auto poses = static_cast<std::size_t>(head.shape.front());
  if (head.shape.size() == 2) return i + poses * k;
  return i + poses * (k / 4 + static_cast<std::size_t>(head.shape[1]) * (k % 4));
}

PoseFile read_array(const std::filesystem::path& path) {
  const auto raw = read_bytes(path);
  const std::string_view bytes(reinterpret_cast<const char*>(raw.data()), raw.size());
  const RecordReading reading;
  const NpyHead head = npy_head({path, bytes, reading});
  const std::size_t numbers = numbers_of_pose(head, path.string());
  const NpyField& number = head.type.fields.front();
  const auto size = static_cast<std::size_t>(number.field.size);
  const std::size_t count = head.body.size() / (numbers * size);
  if (head.shape.front() != count || head.body.size() % (numbers * size) != 0) {
    throw DataError(path.string() + ": should hold " + grouped_text(head.shape.front()) +
                    " poses, but has bytes for " + grouped_text(count) +
                    "; the file looks truncated.");
  }
  PoseColumns columns;
  columns.rotation = numbers == 16 ? Rotation::kMatrix4x4 : Rotation::kMatrix3x4;
  PoseFile file;
  file.path = path;
  file.is_binary = true;
  std::vector<double> values(numbers);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < numbers; ++k) {
      values[k] = number_at(head.body.data() + place_of(head, i, k, numbers) * size, size,
                            number.big_endian);
    }
    const std::string where = path.string() + ": pose " + std::to_string(i + 1);
    file.rows.push_back({.matrix = pose_matrix(values, columns, where), .line = i + 1});
  }
  return file;
}

/// LIO-SAM's transformations.pcd: x y z roll pitch yaw time.
PoseFile read_key_poses(const std::filesystem::path& path) {
  const PointRecords records = read_records(path);
  const PositionFields at = position_fields(records.layout, path.string());
  const PointField* roll = records.layout.find({"roll"});
  const PointField* pitch = records.layout.find({"pitch"});
  const PointField* yaw = records.layout.find({"yaw"});
  const PointField* time = records.layout.find({"time"});
  if (roll == nullptr || pitch == nullptr || yaw == nullptr) {
    throw DataError(path.string() +
                    ": has no fields roll, pitch and yaw, so it holds positions "
                    "only. LIO-SAM writes whole poses to transformations.pcd.");
  }
  PoseColumns columns;
  columns.rotation = Rotation::kEulerRadians;
  columns.position = {0, 1, 2};
  columns.turn = {3, 4, 5, 5};
  PoseFile file;
  file.path = path;
  file.is_binary = true;
  std::vector<std::string> times;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const std::vector<double> numbers = {records.value(i, at.x),   records.value(i, at.y),
                                         records.value(i, at.z),   records.value(i, *roll),
                                         records.value(i, *pitch), records.value(i, *yaw)};
    const std::string where = path.string() + ": pose " + std::to_string(i + 1);
    file.rows.push_back({.matrix = pose_matrix(numbers, columns, where), .line = i + 1});
    if (time != nullptr) times.push_back(number_text(records.value(i, *time)));
  }
  if (time == nullptr) return file;
  if (time->size < 8 && !times.empty() && std::abs(records.value(0, *time)) > 1e6) {
    throw DataError(path.string() +
                    ": the times are float32, which holds times since 1970 to "
                    "about two minutes only; write the field 'time' as float64 (SIZE 8, TYPE F).");
  }
  set_stamps(file, {times.begin(), times.end()}, {}, std::nullopt);
  return file;
}

}  // namespace

std::vector<PoseFormatName> binary_format_names() {
  return {
      {"npy", "an array of N x 4 x 4 or N x 3 x 4 numbers (KISS-ICP's .npy)"},
      {"lio-sam", "a .pcd file with x y z roll pitch yaw time (LIO-SAM's transformations.pcd)"}};
}

std::optional<PoseFile> read_binary_poses(const std::filesystem::path& path,
                                          const PoseReading& reading) {
  const std::string head = read_piece(path, 0, 16);
  const std::string given = reading.format.value_or("");
  const auto name = [](PoseFile file, const char* format) {
    file.format = format;
    return file;
  };
  if (given == "npy" || (given.empty() && head.starts_with(kNumpyMagic))) {
    return name(read_array(path), "npy");
  }
  const bool is_pcd =
      head.starts_with("# .PCD") || head.starts_with("VERSION") || path.extension() == ".pcd";
  if (given == "lio-sam" || (given.empty() && is_pcd)) {
    return name(read_key_poses(path), "lio-sam");
  }
  if (given.empty() && head.find('\0') != std::string::npos) {
    throw DataError(path.string() +
                    ": is neither text nor a .npy file; expected a pose file. `raymoval list "
                    "pose-formats` names all forms.");
  }
  return std::nullopt;
}

}  // namespace raymoval::pose_formats
