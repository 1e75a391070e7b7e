// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/text.h"
#include "datasets/clouds/format/cloud_format.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// Largest number of points of a file: readers of .pcd and .ply count with 32 bits.
constexpr std::uint64_t kMostCloudPoints = 0xFFFFFFFFU;

// More than any sensor's record; these guard the arithmetic that follows.
constexpr int kLargestCount = 65536;
constexpr std::size_t kLargestRow = 1 << 20;

enum class CloudEncoding {
  kAscii,       ///< A line per point.
  kBinary,      ///< A record per point.
  kCompressed,  ///< PCD: all values of a field after one another, LZF-compressed.
};

/// The head of a PCD or PLY file, checked for consistency.
struct CloudHeader {
  CloudEncoding encoding = CloudEncoding::kBinary;
  bool big_endian = false;
  /// Includes padding (PCD's fields "_").
  std::vector<PointField> fields;
  std::uint64_t points = 0;
  std::uint64_t width = 0, height = 1;  ///< Of an organised cloud; points is their product.
  bool points_end_the_file = true;      ///< False for PLY, where faces may follow.
  std::size_t body_offset = 0;          ///< Bytes before the data of the points.
  std::size_t body_line = 1;            ///< Line at which ASCII data starts, from 1.
  /// PCD: tx ty tz qw qx qy qz.
  std::optional<Eigen::Matrix<double, 7, 1>> viewpoint;

  [[nodiscard]] std::size_t row_bytes() const;
  /// Position of the first field with one of `names`, if there is one.
  [[nodiscard]] std::optional<std::size_t> find(const std::vector<std::string_view>& names) const;
  /// Adds a field behind the others.
  void add(std::string name, char type, int size, int count);
};

/// PCD's name for filler bytes; binary_compressed leaves them out.
inline bool is_padding(const PointField& field) {
  return field.name == "_";
}

/// @throws DataError for implausibly large rows or counts, and if x, y or z is missing
void check_fields(const CloudHeader& header, const std::filesystem::path& path);

/// Lines of a header, one by one, with their line numbers for messages.
class HeaderLines {
 public:
  HeaderLines(std::string_view bytes, const std::filesystem::path& path, const char* last_entry)
      : bytes_(bytes), path_(path), last_entry_(last_entry) {}

  /// Words of the next line. @throws DataError at the end of the file
  std::vector<std::string_view> next();
  [[nodiscard]] std::size_t offset() const { return at_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[noreturn]] void fail(const std::string& what) const;
  template <class Number>
  Number number(std::string_view text, Number minimum, Number maximum) const {
    const auto value = parse_number<Number>(text);
    if (!value || *value < minimum || *value > maximum) {
      fail("'" + std::string(text.substr(0, 40)) + "' is not a number that is valid here.");
    }
    return *value;
  }

 private:
  std::string_view bytes_;
  const std::filesystem::path& path_;
  const char* last_entry_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
};

/// The header of a PCD file.
/// @param bytes the file, or at least its whole header
/// @throws DataError with file and line: missing or contradictory entries, unknown types, no x y z
CloudHeader parse_pcd_header(std::string_view bytes, const std::filesystem::path& path);

/// The header of a PLY file.
/// @param bytes the file, or at least its whole header
/// @throws DataError as `parse_pcd_header`; for a vertex with a list; for elements with items
///   before the vertices
CloudHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& path);

/// The positions and intensities of the points of a PCD or PLY file. In ASCII files, other fields
/// are not parsed.
/// @param origin as `read_cloud`
/// @throws DataError with line and column for a word that is no number, with the line for a wrong
///   number of values or of lines; if the body is shorter than the header's points, or a compressed
///   body is damaged
Cloud header_cloud(const CloudHeader& header, const CloudBytes& file,
                   const Eigen::Vector3d& origin);

/// All fields of the points of a PCD or PLY file. In ASCII files, whole types are exact to 64 bits
/// and reals are rounded to nearest; padding is read if it is a number.
/// @throws DataError as `header_cloud`, also for a number out of range of the field's type
PointRecords header_records(const CloudHeader& header, const CloudBytes& file);

/// A format whose files begin with a header. The caller adds the parts of writing that differ from
/// format to format.
/// @tparam parse the header of a file, from its bytes and its path
template <class Encoder, CloudHeader (*parse)(std::string_view, const std::filesystem::path&)>
CloudFormat header_format(const std::string& extension) {
  CloudFormat format{extension};
  format.read_cloud = [](const CloudBytes& file, const Eigen::Vector3d& origin) {
    return header_cloud(parse(file.text, file.path), file, origin);
  };
  format.read_records = [](const CloudBytes& file) {
    return header_records(parse(file.text, file.path), file);
  };
  format.encoder = [](const std::filesystem::path&) -> std::unique_ptr<RecordEncoder> {
    return std::make_unique<Encoder>();
  };
  return format;
}

}  // namespace raymoval
