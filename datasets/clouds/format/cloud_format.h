// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "datasets/records/point_records.h"

namespace raymoval {

/// Points as a file stores them, non-finite ones included.
struct Cloud {
  std::vector<Eigen::Vector3f> points;
  /// The intensity of each return: the field with one of `intensity_names`. As long as `points`, or
  /// empty if the file has no such field with one value per point.
  std::vector<float> intensity;
};

/// What to do about a damaged file.
inline constexpr const char* kRereadRemedy =
    " Copy it again, or leave it out with --skip-bad-scans.";

/// Facts that a file does not state.
struct RecordReading {
  /// Fields of a .bin file or the columns of an .npy array, such as "x y z intensity t:f8" (float32
  /// where no type is given), see `parse_point_layout`.
  std::optional<std::string> point_layout = std::nullopt;
};

/// The content of a file of points.
struct CloudBytes {
  const std::filesystem::path& path;  ///< For messages.
  std::string_view text;
  const RecordReading& reading;
};

/// Width and height of a written file: those of its piece if there is only one.
class WrittenShape {
 public:
  void add(const PointRecords& rows) {
    if (rows.size() == 0) return;
    ++pieces_;
    width_ = rows.width;
    height_ = rows.height;
  }
  /// Width and height of a file of `points` points.
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> of(std::uint64_t points) const {
    if (pieces_ == 1 && width_ * height_ == points) return {width_, height_};
    return {points, 1};
  }

 private:
  std::uint64_t pieces_ = 0, width_ = 0, height_ = 1;
};

/// Encodes rows of points in one format. A file is its head, followed by the result of `rows` for
/// each piece.
class RecordEncoder {
 public:
  virtual ~RecordEncoder() = default;
  /// @param first the first rows of the file, perhaps none, with the layout of all rows
  virtual void start(const PointRecords& first) = 0;
  /// The head of a file of `points` points. It has the same length for any count.
  [[nodiscard]] virtual std::string head(std::uint64_t points) const = 0;
  /// The bytes of more rows: a copy, unless the format encodes them otherwise.
  /// @throws DataError for a value that the format cannot hold
  virtual std::string rows(const PointRecords& more) {
    return {reinterpret_cast<const char*>(more.bytes.data()), more.bytes.size()};
  }
};

/// A file format of points. Each format has its own source file and is listed in
/// datasets/clouds/cloud_file.cpp.
struct CloudFormat {
  std::string extension;  ///< ".pcd".
  Cloud (*read_cloud)(const CloudBytes& file, const Eigen::Vector3d& origin) = nullptr;
  PointRecords (*read_records)(const CloudBytes& file) = nullptr;
  /// Null if the format is only read.
  std::unique_ptr<RecordEncoder> (*encoder)(const std::filesystem::path& path) = nullptr;
  /// As `format_losses`; null if the format is only read.
  std::vector<std::string> (*lost)(const RecordLayout& layout) = nullptr;
  /// The layout of the records of a file without reading its points; null if that is no faster.
  RecordLayout (*read_layout)(const std::filesystem::path& path,
                              const RecordReading& reading) = nullptr;
};

/// PCD 0.7: ascii, binary and binary_compressed are read, binary is written. Padding (fields "_")
/// becomes bytes between the fields of a record, and such bytes are written as padding. VIEWPOINT
/// is written if all rows have the same. WIDTH and HEIGHT are kept if an organised cloud is written
/// in one piece.
CloudFormat pcd_format();

/// PLY 1.0: ascii and binary of either endianness are read, binary little-endian is written. Other
/// elements, before and after the vertices, are skipped.
CloudFormat ply_format();

/// Rows of numbers without a head, little-endian: x y z intensity as float32, or the given point
/// layout. Rows are written unchanged.
CloudFormat bin_format();

/// LAS 1.0 to 1.4 with the point formats 0 to 10; LAS 1.4 with the formats 6 to 8 is written (see
/// las_encoder.h). Coordinates are float64 fields x, y and z in metres, values of a few bits are
/// uint8 fields. Extra bytes are fields as described in the file; their scales are not applied.
CloudFormat las_format();

/// NumPy's .npy: arrays of named fields (N or H x W), and arrays of numbers of one type (N x k or
/// H x W x k), whose columns are named by the point layout, or x y z intensity field_4 and so on.
/// Arrays of columns (Fortran order) are read too. Points are written as an array of fields;
/// numbers of one type that never had names as an array of numbers.
CloudFormat npy_format();

/// NumPy's .npz, a zip archive of such arrays, stored or deflated: the only array, or the one named
/// points or arr_0. It is only read.
CloudFormat npz_format();

}  // namespace raymoval
