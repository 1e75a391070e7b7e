// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/files/file_writer.h"
#include "core/files/replacements.h"
#include "core/scan/scan.h"
#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// Endings of files that can be read, ".pcd" and so on.
const std::vector<std::string>& cloud_extensions();

/// Endings of files that can be written, such as maps.
const std::vector<std::string>& written_extensions();

/// The entry of `cloud_extensions` in which the name of `path` ends; empty if there is none.
std::string cloud_extension(const std::filesystem::path& path);

/// The name of `path` without its folder and `cloud_extension`: "000123" of a/000123.pcd.
std::string cloud_stem(const std::filesystem::path& path);

/// For a known extension that is not supported: a sentence that names a program to convert the
/// file. Empty for other extensions.
std::string conversion_text(const std::filesystem::path& path);

/// Reads positions and intensities of the points of a file of any known format, see
/// `cloud_extensions`.
/// @throws DataError naming the file, and the byte, point or line that is wrong; UsageError for
///   another extension or an invalid point layout
/// @param origin metres, subtracted from each point in double precision before rounding to float32:
///   points near `origin` keep their digits, also far from the file's origin
/// @note VIEWPOINT is never applied to the points.
Cloud read_cloud(const std::filesystem::path& path,
                 const Eigen::Vector3d& origin = Eigen::Vector3d::Zero(),
                 const RecordReading& reading = {});

/// Sensor pose from the VIEWPOINT entry of a .pcd file, without reading its points.
/// @throws DataError if there is none or it is no rigid pose
Pose read_viewpoint(const std::filesystem::path& path);

/// Checks the size of a .bin scan.
/// @throws DataError if `bytes` is no multiple of the size of a point: that of the point layout, or
///   16
void check_bin_size(const std::filesystem::path& path, std::uintmax_t bytes,
                    const RecordReading& reading = {});

/// Refuses .bin scans whose points have 3, 5, 6 or 7 float32 and would be read as points of 4.
///
/// Under the right width, columns have different distributions: x, z and a ring differ. Under a
/// wrong width, each column is a mixture of all. Scans are refused only if their columns differ
/// under the other width and are alike under 4, in each of up to five scans, and if the size of
/// every scan fits the other width. Columns are compared by the Kolmogorov-Smirnov distance, which
/// does not depend on the order of points, on units, or on the meaning of a column.
/// @param scans files of any format; other formats than .bin and files with fewer than 2,520
///   numbers are not checked
/// @throws DataError naming a scan and the width that fits, unless `reading` names the point layout
/// @note Points of 8 float32 look like points of 4, and are not found.
void check_bin_width(const std::vector<std::filesystem::path>& scans, const RecordReading& reading);

/// Reads all fields of all points, bit for bit, of a file of any known format.
/// @throws DataError naming the file, and the byte, point or line that is wrong; UsageError for an
///   unknown extension
PointRecords read_records(const std::filesystem::path& path, const RecordReading& reading = {});

/// The layout of the result of `read_records`. Where the format allows it, points are not read.
/// @throws as `read_records`, except for errors in the points
RecordLayout read_layout(const std::filesystem::path& path, const RecordReading& reading = {});

/// Sentences on fields of `layout` that the format of `path` cannot store bit for bit; none if all
/// can be stored. @throws UsageError for an unknown extension
std::vector<std::string> format_losses(const std::filesystem::path& path,
                                       const RecordLayout& layout);

/// The bytes of a file named `path` with these points.
/// @throws UsageError for an unknown extension; DataError as `PointRecordWriter::add`
std::string whole_file(const std::filesystem::path& path, const PointRecords& records);

/// The number type of x, y and z in a cloud file.
enum class Coordinates { kFloat, kDouble };

/// Refuses a format that cannot hold `coordinates`: .bin has float32 only.
/// @throws UsageError naming the file and the remedy
void check_coordinates(const std::filesystem::path& path, Coordinates coordinates);

/// Writes points with all their fields piece by piece; memory holds one piece. The extension gives
/// the format. The file appears at `commit`, whole.
class PointRecordWriter {
 public:
  /// Opens the file. @throws UsageError for an unknown extension, DataError if it cannot be written
  explicit PointRecordWriter(const std::filesystem::path& path);

  /// To be called once before `add`, with the layout that all pieces have.
  void start(const RecordLayout& layout);
  /// @param rows of the layout given to `start`
  /// @throws DataError when the disk is full, beyond 4,294,967,295 points, or for a coordinate that
  ///   the format cannot hold
  void add(const PointRecords& rows);
  /// Completes the file on the disk, still under a temporary name.
  void finish();
  /// Gives the file its name, after `finish`.
  void commit() { file_.commit(); }
  /// As `commit`, together with other files.
  void commit_with(Replacements& together) { file_.commit_with(together); }
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  void begin(const PointRecords& first);

  std::unique_ptr<RecordEncoder> encoder_;
  FileWriter file_;
  RecordLayout layout_;
  std::uint64_t points_ = 0;
  bool begun_ = false;
};

}  // namespace raymoval
