// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "datasets/records/point_records.h"

namespace raymoval {

/// The frame of the stored points of a scan: the sensor's, or the world of the poses.
enum class PointFrame { kSensor, kWorld };

/// The records of each scan of a sequence, with all fields. The `ScanSource` has only the data for
/// methods: row `scan.stored_position(i)` here is point i there. Calls are thread-safe; no
/// implementation holds all scans in memory.
class RecordSource {
 public:
  virtual ~RecordSource() = default;
  /// The stored records of scan `index`: in the stored frame, without correction of motion within
  /// the scan. @throws DataError as `ScanSource::load`
  [[nodiscard]] virtual PointRecords records(std::size_t index) const = 0;
  /// The layout of these records. A source overrides this if it need not read all points.
  /// @throws DataError as `records`
  [[nodiscard]] virtual RecordLayout layout(std::size_t index) const {
    return records(index).layout;
  }
  [[nodiscard]] virtual PointFrame point_frame() const = 0;
  /// Where scan `index` is stored, for messages: a path, or a bag, topic and number.
  [[nodiscard]] virtual std::string place(std::size_t index) const = 0;
};

}  // namespace raymoval
