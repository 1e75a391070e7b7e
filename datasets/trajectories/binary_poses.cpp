// SPDX-License-Identifier: MIT
#include "datasets/trajectories/binary_poses.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/record_file.h"
#include "datasets/trajectories/pose_columns.h"

namespace raymoval::pose_formats {
namespace {

constexpr std::string_view kNumpyMagic = "\x93NUMPY";

/// What the head of an .npy file says, as far as arrays of matrices need it.
struct ArrayHead {
  std::string type;  ///< "<f8".
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t data = 0;  ///< First byte of the values.
};

[[noreturn]] void throw_head(const std::filesystem::path& path) {
  throw DataError(path.string() +
                  ": the head of the .npy file is damaged; write it again with "
                  "numpy.save.");
}

/// The text behind `key` in the head, up to `end`.
std::string value_of(const std::string& head, const std::string& key, char begin, char end,
                     const std::filesystem::path& path) {
  const std::size_t at = head.find("'" + key + "'");
  const std::size_t colon = at == std::string::npos ? at : head.find(':', at);
  const std::size_t from = colon == std::string::npos ? colon : head.find(begin, colon);
  const std::size_t to = from == std::string::npos ? from : head.find(end, from + 1);
  if (to == std::string::npos) throw_head(path);
  return head.substr(from + 1, to - from - 1);
}

ArrayHead parse_head(const std::string& bytes, const std::filesystem::path& path) {
  const auto byte = [&](std::size_t at) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at]));
  };
  if (bytes.size() < 12) throw_head(path);
  const bool first_version = byte(6) == 1;
  const std::size_t begin = first_version ? 10 : 12;
  const std::size_t length =
      byte(8) + 256 * byte(9) + (first_version ? 0 : 65536 * (byte(10) + 256 * byte(11)));
  if (length > bytes.size() - begin) throw_head(path);
  const std::string head = bytes.substr(begin, length);
  ArrayHead array;
  array.data = begin + length;
  array.type = value_of(head, "descr", '\'', '\'', path);
  array.fortran_order = value_of(head, "fortran_order", ' ', ',', path).starts_with("True");
  for (const std::string_view size : split(value_of(head, "shape", '(', ')', path), ',')) {
    const auto words = split_blanks(size);
    if (words.empty()) continue;
    const auto number = parse_number<std::size_t>(words.front());
    if (!number) throw_head(path);
    array.shape.push_back(*number);
  }
  return array;
}

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

/// An array N x 4 x 4, N x 3 x 4, N x 12 or N x 16.
PoseFile read_array(const std::filesystem::path& path) {
  const auto raw = read_bytes(path);
  const std::string bytes(reinterpret_cast<const char*>(raw.data()), raw.size());
  const ArrayHead head = parse_head(bytes, path);
  std::size_t numbers = 1;
  for (std::size_t i = 1; i < head.shape.size(); ++i) {
    numbers = head.shape[i] > 16 ? 17 : std::min<std::size_t>(numbers * head.shape[i], 17);
  }
  const bool form = head.shape.size() == 2 || (head.shape.size() == 3 && head.shape[2] == 4);
  if (!form || (numbers != 12 && numbers != 16)) {
    std::vector<std::string> sizes;
    for (const std::size_t size : head.shape) sizes.push_back(std::to_string(size));
    throw DataError(path.string() + ": is an array of " + join(sizes, " x ") +
                    "; expected N x 4 x 4 or N x 3 x 4 matrices.");
  }
  const std::string kind = head.type.size() == 3 ? head.type.substr(1) : "";
  if ((kind != "f8" && kind != "f4") || head.fortran_order) {
    throw DataError(path.string() + ": holds numbers of type '" + head.type +
                    (head.fortran_order ? "' in Fortran order" : "'") +
                    "; expected float64 or float32 in C order.");
  }
  const std::size_t size = kind == "f8" ? 8 : 4, row = numbers * size;
  const std::size_t count = (bytes.size() - head.data) / row;
  if (head.shape.front() != count || (bytes.size() - head.data) % row != 0) {
    throw DataError(path.string() + ": says that it holds " + grouped_text(head.shape.front()) +
                    " poses, but has the bytes of " + grouped_text(count) +
                    "; the file looks cut.");
  }
  PoseColumns columns;
  columns.rotation = numbers == 16 ? Rotation::kMatrix4x4 : Rotation::kMatrix3x4;
  PoseFile file;
  file.path = path;
  file.is_binary = true;
  std::vector<double> values(numbers);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < numbers; ++k) {
      values[k] =
          number_at(bytes.data() + head.data + i * row + k * size, size, head.type.front() == '>');
    }
    PoseFile::Row pose;
    pose.line = i + 1;
    pose.matrix = pose_matrix(values, columns, path.string() + ": pose " + std::to_string(i + 1));
    file.rows.push_back(pose);
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
    PoseFile::Row pose;
    pose.line = i + 1;
    pose.matrix = pose_matrix(numbers, columns, path.string() + ": pose " + std::to_string(i + 1));
    file.rows.push_back(pose);
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
    if (!head.starts_with(kNumpyMagic)) throw_head(path);
    return name(read_array(path), "npy");
  }
  const bool is_pcd =
      head.starts_with("# .PCD") || head.starts_with("VERSION") || path.extension() == ".pcd";
  if (given == "lio-sam" || (given.empty() && is_pcd)) {
    return name(read_key_poses(path), "lio-sam");
  }
  if (given.empty() && head.find('\0') != std::string::npos) {
    throw DataError(path.string() +
                    ": is no text and no .npy file; expected a pose file. "
                    "`raymoval list pose-formats` names all forms.");
  }
  return std::nullopt;
}

}  // namespace raymoval::pose_formats
