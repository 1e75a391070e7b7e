// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "datasets/records/point_records.h"

namespace raymoval {

/// The frame that the points of a scan are stored in: the sensor's, or the world of the poses.
enum class PointFrame { kSensor, kWorld };

/// What is stored of each scan of a sequence, with all fields. It stands beside the `ScanSource`,
/// which has only what methods see: row `scan.stored_position(i)` here is point i there. Calls are
/// thread-safe; nothing behind this interface holds all scans.
class RecordSource {
 public:
  virtual ~RecordSource() = default;
  /// The records of scan `index` as they are stored: before any motion within the scan is taken
  /// out, in the frame that they are stored in. @throws DataError as `ScanSource::load`
  [[nodiscard]] virtual PointRecords records(std::size_t index) const = 0;
  /// The layout of these records. Where it can be known without reading all points, a source says
  /// so by a function of its own. @throws DataError as `records`
  [[nodiscard]] virtual RecordLayout layout(std::size_t index) const {
    return records(index).layout;
  }
  [[nodiscard]] virtual PointFrame point_frame() const = 0;
  /// Where scan `index` is stored, for messages: a path, or a bag, topic and number.
  [[nodiscard]] virtual std::string place(std::size_t index) const = 0;
};

}  // namespace raymoval
