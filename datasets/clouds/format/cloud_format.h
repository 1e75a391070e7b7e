// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/clouds/format/cloud_bytes.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// How the points of a file that is written are organised: as the one piece they come in, if they
/// do.
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

/// Makes the bytes of a file of one format of rows of points. A file is its head and, behind that,
/// what `rows` gives of each piece, and `rest`.
class RecordEncoder {
 public:
  virtual ~RecordEncoder() = default;
  /// @param first rows that the file begins with, perhaps none, with the layout of all rows
  virtual void start(const PointRecords& first) = 0;
  /// The head of a file of `points` points. It has the same length for any count.
  [[nodiscard]] virtual std::string head(std::uint64_t points) const = 0;
  /// The bytes of more rows. @throws DataError for a value that the format cannot hold
  virtual std::string rows(const PointRecords& more) = 0;
  /// What stands behind all rows; called once, before the last `head`.
  /// @throws DataError as `rows`
  virtual std::string rest() { return ""; }
};

/// A kind of file that points are read from and written to. Each stands in a folder of its own and
/// is listed in datasets/clouds/formats.cpp.
struct CloudFormat {
  std::string extension;  ///< ".pcd".
  Cloud (*read_cloud)(const CloudBytes& file, const Eigen::Vector3d& origin) = nullptr;
  PointRecords (*read_records)(const CloudBytes& file) = nullptr;
  /// Makes what stands in the file, or in its `wrap`.
  std::unique_ptr<RecordEncoder> (*encoder)(const std::filesystem::path& path,
                                            const RecordWriting& writing) = nullptr;
  /// As `what_is_lost`.
  std::vector<std::string> (*lost)(const RecordLayout& layout) = nullptr;
  bool holds_reference_system = false;
  /// The layout of the records of a file without reading its points; null if it takes as much.
  RecordLayout (*read_layout)(const std::filesystem::path& path,
                              const RecordReading& reading) = nullptr;
  /// Makes a file of what the encoder made. Formats that have it are written whole only, by
  /// `whole_file`.
  std::string (*wrap)(const std::string& content, const StoredForm& form) = nullptr;
  /// As `shown_intensity`; null if the format shows no values otherwise than they are.
  std::optional<ShownIntensity> (*shown_intensity)(const RecordLayout& layout) = nullptr;
};

}  // namespace raymoval
