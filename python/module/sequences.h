// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/suite/suite.h"
#include "core/scan/mask_store.h"
#include "core/scan/scan_source.h"
#include "datasets/clouds/file_source.h"
#include "python/module/arrays.h"
#include "python/module/scans.h"

namespace raymoval::python {

/// Where the points of scans come from, by the number of the scan. Thread-safe, without the GIL.
class PointStore {
 public:
  virtual ~PointStore() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;
  [[nodiscard]] virtual Cloud points(std::size_t scan) const = 0;
};

/// The points of a list, a tuple or an array of arrays are used in place. The points of another
/// sequence are requested scan by scan, by one thread at a time. An iterator (a generator) is
/// written to an unnamed file below TMPDIR, so that memory does not grow with the scans.
/// @param most the number of poses: at most one scan more is taken from a generator
/// @throws UsageError for an object without scans, and for wrong shapes and types if they are known
///   yet; DataError if the file cannot be written; errors of the iterator
/// @note To be called with the GIL.
std::shared_ptr<const PointStore> point_store(const py::object& scans, std::size_t most);

/// Scans from arrays with poses. Missing returns are left out, as of files (see `read_returns`).
class ArraySource : public ScanSource {
 public:
  struct Facts {
    std::vector<Pose> poses;
    std::vector<double> times;               ///< Seconds; as many as poses.
    std::optional<SensorModel> sensor = {};  ///< Takes precedence over `sensor_name`.
    std::optional<std::string> sensor_name = {};
  };
  /// @throws UsageError if there are more or fewer poses than scans, or neither; ConfigurationError
  ///   for an unknown sensor
  ArraySource(std::shared_ptr<const PointStore> points, Facts facts);

  [[nodiscard]] std::size_t size() const override { return facts_.poses.size(); }
  /// @throws DataError as `read_returns`; UsageError for points of a wrong shape or type; what the
  ///   sequence of scans raises
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override { return facts_.poses[index]; }
  [[nodiscard]] const SensorModel& sensor() const override;
  /// Which rows hold no return, of the scans that were loaded; none of a scan in which each does.
  [[nodiscard]] MaskStore left_out() const;

 private:
  std::shared_ptr<const PointStore> points_;
  Facts facts_;
  SensorChoice sensor_;
  mutable std::mutex mutex_;
  mutable MaskStore left_out_;
};

/// A sequence as Python sees it.
struct HeldSequence {
  std::shared_ptr<const Sequence> sequence;
  std::shared_ptr<const Truth> truth;
  /// Where it was opened. No value for arrays, which a run cannot open again.
  std::optional<SequenceRequest> place = std::nullopt;
  /// The scans if they are arrays; else null.
  std::shared_ptr<const ArraySource> arrays = nullptr;

  /// Number of values that a mask of a scan has: one for each row of an array, and one for each
  /// point of an opened scan.
  /// @param scan as it was loaded
  [[nodiscard]] std::size_t mask_size(const Scan& scan) const {
    return arrays ? scan.stored_point_count : scan.size();
  }
};

}  // namespace raymoval::python
