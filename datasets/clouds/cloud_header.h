// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raymoval {

/// Points of one file: what .pcd and .ply readers, ours among them, hold counts in.
constexpr std::uint64_t kMostCloudPoints = 0xFFFFFFFFU;

/// One named value (or `count` of them) of a point record.
struct CloudField {
  std::string name;
  char type = 'F';  ///< F real, I signed, U unsigned.
  int size = 4;     ///< Bytes of one value: 1, 2, 4 or 8.
  int count = 1;

  [[nodiscard]] std::size_t bytes() const {
    return static_cast<std::size_t>(size) * static_cast<std::size_t>(count);
  }
  /// PCD's name for filler bytes; binary_compressed leaves them out.
  [[nodiscard]] bool is_padding() const { return name == "_"; }
};

enum class CloudEncoding {
  kAscii,       ///< A line per point.
  kBinary,      ///< A record per point.
  kCompressed,  ///< PCD: all values of a field after one another, LZF-compressed.
};

/// What the head of a PCD or PLY file says, checked for sense.
struct CloudHeader {
  CloudEncoding encoding = CloudEncoding::kBinary;
  bool big_endian = false;
  std::vector<CloudField> fields;
  std::uint64_t points = 0;
  bool points_end_the_file = true;  ///< False for PLY, where faces may follow.
  std::size_t body_offset = 0;      ///< Bytes before the data.
  std::size_t body_line = 1;        ///< Line at which ASCII data starts, from 1.
  /// PCD: tx ty tz qw qx qy qz.
  std::optional<Eigen::Matrix<double, 7, 1>> viewpoint;

  [[nodiscard]] std::size_t row_bytes() const;
  /// Position of the first field with one of `names`, or nothing.
  [[nodiscard]] std::optional<std::size_t> find(const std::vector<std::string_view>& names) const;
};

/// @param bytes the file, or at least its whole header
/// @throws DataError with file and line: missing or contradictory entries, unknown types, no x y z
CloudHeader parse_pcd_header(std::string_view bytes, const std::filesystem::path& path);
CloudHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& path);

}  // namespace raymoval
