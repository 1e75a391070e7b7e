// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/files/replacements.h"
#include "datasets/clouds/format/cloud_bytes.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// Reads all fields of all points, bit for bit, of a file of any known format.
/// @throws DataError naming the file, and the byte, point or line that is wrong; UsageError for an
///   unknown extension
PointRecords read_records(const std::filesystem::path& path, const RecordReading& reading = {});

/// The layout of what `read_records` gives, where the format allows that without reading the
/// points.
/// @throws as `read_records`, save that points are not looked at
RecordLayout read_layout(const std::filesystem::path& path, const RecordReading& reading = {});

/// What the format of `path` cannot hold of points of `layout`, in whole sentences that name the
/// fields; none if every field goes through bit for bit. @throws UsageError for an unknown
/// extension
std::vector<std::string> what_is_lost(const std::filesystem::path& path,
                                      const RecordLayout& layout);

/// Whether files of the format of `path` say which coordinate reference system they are in.
/// @throws UsageError for an unknown extension
bool holds_reference_system(const std::filesystem::path& path);

/// The field of `layout` that files of the format of `path` also show rounded, times
/// `RecordWriting::intensity_scale`. Nothing if there is none. @throws UsageError for an unknown
/// extension
std::optional<ShownIntensity> shown_intensity(const std::filesystem::path& path,
                                              const RecordLayout& layout);

/// The bytes of a file named `path` with these points, of any format that is read, in the form that
/// `records` have: text, compressed, another byte order, packed by gzip, an archive of arrays.
/// @throws UsageError for an unknown extension; DataError as `PointRecordWriter::add`
std::string whole_file(const std::filesystem::path& path, const PointRecords& records);

/// Writes points with all their fields piece by piece; only the piece at hand is in memory. The
/// format is that of the extension. The file appears at `commit`, whole.
class PointRecordWriter {
 public:
  /// Opens the file. @throws UsageError for an unknown extension or a `crs` that the format cannot
  ///   hold, DataError if it cannot be written
  explicit PointRecordWriter(const std::filesystem::path& path, const RecordWriting& writing = {});
  ~PointRecordWriter();
  PointRecordWriter(const PointRecordWriter&) = delete;
  PointRecordWriter& operator=(const PointRecordWriter&) = delete;

  /// To be called once before `add`, with the layout that all pieces have.
  void start(const RecordLayout& layout);
  /// @param rows of the layout given to `start`
  /// @throws DataError when the disk is full, beyond 4,294,967,295 points, or for a coordinate that
  ///   the format cannot hold
  void add(const PointRecords& rows);
  /// Ends the file and puts it on the disk, still without its name.
  void finish();
  /// Gives it its name, after `finish`.
  void commit();
  /// The same together with others.
  void commit_with(Replacements& together);
  [[nodiscard]] const std::filesystem::path& path() const;

 private:
  class Format;
  std::unique_ptr<Format> format_;
};

}  // namespace raymoval
