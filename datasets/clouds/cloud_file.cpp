// SPDX-License-Identifier: MIT
#include "datasets/clouds/cloud_file.h"

#include <liblzf/lzf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/cloud_header.h"
#include "datasets/clouds/poses.h"

// PCL's own readers are not used. They trust counts in a header (a damaged file ends the program),
// read garbage in ASCII files as zero, and report on the console; and the library loads VTK, which
// takes longer to start than this program. What it compresses is LZF.

namespace raymoval {
namespace {

static_assert(std::endian::native == std::endian::little, "cloud files are little-endian");

constexpr std::size_t kBinRow = 4 * sizeof(float);

/// Where the values of a field lie: value i at `start + i * step`.
struct Column {
  std::size_t start = 0;
  std::size_t step = 0;
  CloudField field;
  bool swap = false;
  double origin = 0.0;  ///< Taken off each value.
};

/// What is taken off the values of column `column` of x, y, z, intensity.
double origin_of(std::size_t column, const Eigen::Vector3d& origin) {
  return column < 3 ? origin[static_cast<Eigen::Index>(column)] : 0.0;
}

/// x, y, z and perhaps intensity as positions in `CloudHeader::fields`.
std::vector<std::size_t> wanted_fields(const CloudHeader& header) {
  std::vector<std::size_t> wanted;
  for (const char* axis : {"x", "y", "z"}) wanted.push_back(*header.find({axis}));
  const auto intensity = header.find(
      {"intensity", "reflectance", "reflectivity", "scalar_intensity", "scalar_Intensity"});
  if (intensity && header.fields[*intensity].count == 1) wanted.push_back(*intensity);
  return wanted;
}

void put(Cloud& cloud, std::size_t point, std::size_t column, float value) {
  if (column < 3) {
    cloud.points[point][static_cast<Eigen::Index>(column)] = value;
  } else {
    cloud.intensity[point] = value;
  }
}

Cloud sized_cloud(std::size_t points, std::size_t columns) {
  Cloud cloud;
  cloud.points.resize(points);
  if (columns > 3) cloud.intensity.resize(points);
  return cloud;
}

template <class Value>
float value_as_float(const char* at, double origin) {
  Value value;
  std::memcpy(&value, at, sizeof value);
  if (origin == 0.0) return static_cast<float>(value);
  return static_cast<float>(static_cast<double>(value) - origin);
}

float read_value(const char* at, const Column& column) {
  std::array<char, 8> bytes{};
  const auto size = static_cast<std::size_t>(column.field.size);
  std::memcpy(bytes.data(), at, size);
  if (column.swap) std::reverse(bytes.begin(), bytes.begin() + column.field.size);
  const char* const p = bytes.data();
  if (column.field.type == 'F')
    return size == 4 ? value_as_float<float>(p, column.origin)
                     : value_as_float<double>(p, column.origin);
  const bool is_signed = column.field.type == 'I';
  switch (size) {
    case 1:
      return is_signed ? value_as_float<std::int8_t>(p, column.origin)
                       : value_as_float<std::uint8_t>(p, column.origin);
    case 2:
      return is_signed ? value_as_float<std::int16_t>(p, column.origin)
                       : value_as_float<std::uint16_t>(p, column.origin);
    case 4:
      return is_signed ? value_as_float<std::int32_t>(p, column.origin)
                       : value_as_float<std::uint32_t>(p, column.origin);
    default:
      return is_signed ? value_as_float<std::int64_t>(p, column.origin)
                       : value_as_float<std::uint64_t>(p, column.origin);
  }
}

Cloud decode_columns(std::string_view data, const std::vector<Column>& columns,
                     std::size_t points) {
  Cloud cloud = sized_cloud(points, columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (std::size_t i = 0; i < points; ++i) {
      put(cloud, i, c,
          read_value(data.data() + columns[c].start + i * columns[c].step, columns[c]));
    }
  }
  return cloud;
}

Cloud decode_binary(const CloudHeader& header, std::string_view body,
                    const std::filesystem::path& path, const Eigen::Vector3d& origin) {
  const std::size_t row = header.row_bytes();
  if (header.points > body.size() / row) {
    throw DataError(path.string() + ": the header announces " + grouped_text(header.points) +
                    " points of " + std::to_string(row) + " bytes, but only " +
                    grouped_text(body.size()) + " bytes follow it; the file looks truncated " +
                    "after point " + grouped_text(body.size() / row) +
                    ". Copy it again, or leave it out with --frames.");
  }
  std::vector<Column> columns;
  for (const std::size_t wanted : wanted_fields(header)) {
    std::size_t offset = 0;
    for (std::size_t i = 0; i < wanted; ++i) offset += header.fields[i].bytes();
    columns.push_back(
        {offset, row, header.fields[wanted], header.big_endian, origin_of(columns.size(), origin)});
  }
  return decode_columns(body, columns, header.points);
}

/// Undoes the LZF compression of a binary_compressed body after checking the sizes it announces.
std::string decompress(std::string_view body, std::uint64_t expected_bytes,
                       const std::filesystem::path& path) {
  // A back reference of 3 bytes gives at most 264.
  constexpr std::uint64_t kMostGain = 88;
  std::array<std::uint32_t, 2> sizes{};
  if (body.size() >= sizeof sizes) std::memcpy(sizes.data(), body.data(), sizeof sizes);
  const auto [packed, unpacked] = sizes;
  if (body.size() < sizeof sizes || packed > body.size() - sizeof sizes) {
    throw DataError(path.string() + ": " + grouped_text(body.size()) +
                    " bytes follow the header, but its compressed block needs " +
                    grouped_text(std::uint64_t{packed} + sizeof sizes) +
                    "; the file looks truncated. Copy it again, or leave it out with --frames.");
  }
  if (unpacked != expected_bytes) {
    throw DataError(path.string() + ": the compressed block announces " + grouped_text(unpacked) +
                    " bytes, but the header's points take " + grouped_text(expected_bytes) +
                    "; the file is damaged. Copy it again, or leave it out with --frames.");
  }
  std::string data;
  const bool plausible = unpacked <= std::uint64_t{packed} * kMostGain;
  if (plausible) data.resize(unpacked);
  if (unpacked > 0 && (!plausible || ::lzf_decompress(body.data() + sizeof sizes, packed,
                                                      data.data(), unpacked) != unpacked)) {
    throw DataError(path.string() + ": the compressed block is damaged (LZF decoding fails). " +
                    "Copy the file again, or leave it out with --frames.");
  }
  return data;
}

Cloud decode_compressed(const CloudHeader& header, std::string_view body,
                        const std::filesystem::path& path, const Eigen::Vector3d& origin) {
  std::vector<std::size_t> starts;
  std::uint64_t bytes = 0;
  for (const CloudField& field : header.fields) {
    starts.push_back(bytes);
    if (!field.is_padding()) bytes += field.bytes() * header.points;
  }
  const std::string data = decompress(body, bytes, path);
  std::vector<Column> columns;
  for (const std::size_t wanted : wanted_fields(header)) {
    const CloudField& field = header.fields[wanted];
    columns.push_back(
        {starts[wanted], field.bytes(), field, false, origin_of(columns.size(), origin)});
  }
  return decode_columns(data, columns, header.points);
}

/// Column of each wanted field in a line of numbers, from 0, and last the count of columns.
std::vector<std::size_t> ascii_columns(const CloudHeader& header) {
  std::vector<std::size_t> first(header.fields.size() + 1, 0);
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    first[i + 1] = first[i] + static_cast<std::size_t>(header.fields[i].count);
  }
  std::vector<std::size_t> columns;
  for (const std::size_t wanted : wanted_fields(header)) columns.push_back(first[wanted]);
  columns.push_back(first.back());
  return columns;
}

/// The value of a text, less `origin`; nothing if it is no number.
std::optional<float> parsed_value(std::string_view word, double origin) {
  if (origin == 0.0) return parse_number<float>(word);
  const auto value = parse_number<double>(word);
  if (!value) return std::nullopt;
  return static_cast<float>(*value - origin);
}

void decode_line(std::string_view line, const std::string& where,
                 const std::vector<std::size_t>& columns, const Eigen::Vector3d& origin,
                 std::size_t point, Cloud& cloud) {
  const auto words = split_blanks(line);
  if (words.size() != columns.back()) {
    throw DataError(where + ": " + std::to_string(words.size()) + " values; the header announces " +
                    std::to_string(columns.back()) + " a point.");
  }
  for (std::size_t c = 0; c + 1 < columns.size(); ++c) {
    const std::string_view word = words[columns[c]];
    const auto value = parsed_value(word, origin_of(c, origin));
    if (!value) {
      throw DataError(where + ", column " + std::to_string(word.data() - line.data() + 1) + ": '" +
                      std::string(word.substr(0, 40)) + "' is not a number.");
    }
    put(cloud, point, c, *value);
  }
}

Cloud decode_ascii(const CloudHeader& header, std::string_view body,
                   const std::filesystem::path& path, const Eigen::Vector3d& origin) {
  const auto columns = ascii_columns(header);
  // A value takes at least a character and what ends it, save the very last.
  const std::uint64_t possible = (body.size() + 1) / (2 * std::max<std::size_t>(columns.back(), 1));
  Cloud cloud = sized_cloud(std::min(header.points, possible), columns.size() - 1);
  std::size_t line = header.body_line, done = 0;
  for (std::size_t at = 0; at < body.size(); ++line) {
    const std::size_t end = std::min(body.find('\n', at), body.size());
    const std::string_view text = body.substr(at, end - at);
    at = end + 1;
    if (text.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    if (done == header.points && !header.points_end_the_file) break;
    const std::string where = path.string() + ": line " + std::to_string(line);
    if (done == header.points) {
      throw DataError(where + ": more points than the " + grouped_text(header.points) +
                      " the header announces.");
    }
    decode_line(text, where, columns, origin, done++, cloud);
  }
  if (done != header.points) {
    throw DataError(path.string() + ": the header announces " + grouped_text(header.points) +
                    " points, but the file ends after " + grouped_text(done) +
                    "; it looks truncated. Copy it again, or leave it out with --frames.");
  }
  return cloud;
}

Cloud read_bin(const std::filesystem::path& path, const Eigen::Vector3d& origin) {
  const auto bytes = read_bytes(path);
  check_bin_size(path, bytes.size());
  Cloud cloud = sized_cloud(bytes.size() / kBinRow, 4);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    std::array<float, 4> row;
    std::memcpy(row.data(), bytes.data() + i * kBinRow, kBinRow);
    cloud.points[i] = {row[0], row[1], row[2]};
    if (!origin.isZero(0.0)) {
      cloud.points[i] = (cloud.points[i].cast<double>() - origin).cast<float>();
    }
    cloud.intensity[i] = row[3];
  }
  return cloud;
}

[[noreturn]] void throw_unknown_extension(const std::filesystem::path& path) {
  throw UsageError(path.string() + ": '" + path.extension().string() +
                   "' is no known cloud format. Supported are: " + join(cloud_extensions()) + ".");
}

}  // namespace

const std::vector<std::string>& cloud_extensions() {
  static const std::vector<std::string> extensions = {".pcd", ".ply", ".bin"};
  return extensions;
}

void check_bin_size(const std::filesystem::path& path, std::uintmax_t bytes) {
  if (bytes % kBinRow == 0) return;
  throw DataError(path.string() + ": " + grouped_text(bytes) +
                  " bytes is not a multiple of 16 (x y z reflectance as float32); the file looks "
                  "truncated after point " +
                  grouped_text(bytes / kBinRow) +
                  ". Copy it again, or leave it out with --frames.");
}

Cloud read_cloud(const std::filesystem::path& path, const Eigen::Vector3d& origin) {
  const std::string extension = path.extension().string();
  if (extension == ".bin") return read_bin(path, origin);
  if (extension != ".pcd" && extension != ".ply") throw_unknown_extension(path);
  const auto bytes = read_bytes(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const CloudHeader header =
      extension == ".pcd" ? parse_pcd_header(text, path) : parse_ply_header(text, path);
  const std::string_view body = text.substr(header.body_offset);
  switch (header.encoding) {
    case CloudEncoding::kAscii:
      return decode_ascii(header, body, path, origin);
    case CloudEncoding::kBinary:
      return decode_binary(header, body, path, origin);
    case CloudEncoding::kCompressed:
      return decode_compressed(header, body, path, origin);
  }
  throw InternalError("unknown cloud encoding");
}

Pose read_viewpoint(const std::filesystem::path& path) {
  const auto viewpoint = parse_pcd_header(read_piece(path, 0, 65536), path).viewpoint;
  if (!viewpoint) {
    throw DataError(path.string() + ": the header has no VIEWPOINT; expected the sensor pose as " +
                    "tx ty tz qw qx qy qz.");
  }
  return rigid_pose(viewpoint->head<3>(), viewpoint->tail<4>(), path.string() + ": VIEWPOINT");
}

}  // namespace raymoval
