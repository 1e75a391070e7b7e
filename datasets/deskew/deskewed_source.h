// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scan/scan_source.h"
#include "datasets/deskew/point_times.h"
#include "datasets/records/record_source.h"
#include "datasets/trajectories/pose_lookup.h"

namespace raymoval {

/// What the motion within scans is taken out with.
struct DeskewInput {
  std::shared_ptr<const RecordSource> records;
  std::shared_ptr<const SensorMotion> motion;
  std::vector<Nanoseconds> stamps;  ///< Of each scan, on the clock of `motion`.
};

/// Finds out how the points of a sequence are timed, from its first, middle and last scan.
/// @throws DataError as `find_point_clock` and `load`
PointClock find_point_clock(const ScanSource& scans, const DeskewInput& input,
                            const std::optional<std::string>& unit);

/// Scans of another source without the motion of the sensor during the scan: each point is where
/// the sensor would have seen it at the time of the scan. The sensor moves evenly between the poses
/// that are known; a little before the first and after the last one, it moves on as it moved there.
class DeskewedSource : public ScanSource {
 public:
  DeskewedSource(std::shared_ptr<const ScanSource> whole, DeskewInput input, PointClock clock);

  [[nodiscard]] std::size_t size() const override { return whole_->size(); }
  /// @throws DataError also for a point whose time is not finite, or so far from the poses that the
  ///   motion is unknown
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override { return whole_->pose(index); }
  /// The directions that the sensor measures in, which are those before the motion is taken out.
  [[nodiscard]] const SensorModel& sensor() const override { return whole_->sensor(); }

  [[nodiscard]] const ScanSource& whole() const { return *whole_; }
  [[nodiscard]] const PointClock& clock() const { return clock_; }

 private:
  std::shared_ptr<const ScanSource> whole_;
  DeskewInput input_;
  PointClock clock_;
};

}  // namespace raymoval
