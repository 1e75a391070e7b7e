// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/scan_source.h"
#include "datasets/records/point_records.h"
#include "datasets/records/record_source.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// How the times of the points of a sequence are to be read.
struct PointClock {
  /// What the times count from.
  enum class Zero {
    kScanTime,    ///< The time of the scan.
    kClock,       ///< The zero of the clock that scans have their times on.
    kFirstPoint,  ///< Another clock: the earliest point was taken at the time of the scan.
  };
  std::string field;    ///< Its name in the records.
  double unit_s = 1.0;  ///< Seconds for one of it.
  Zero zero = Zero::kScanTime;
  std::string text;                ///< All that: "time in seconds from the time of the scan".
  double longest_s = 0.0;          ///< Seconds from the earliest to the latest point of a scan.
  std::vector<std::string> notes;  ///< What was concluded, in whole sentences.
};

/// A scan and what is stored of it.
struct TimedScan {
  Scan scan;
  PointRecords records;
  Nanoseconds stamp = 0;
  std::string place;  ///< For messages.
};

/// The seconds of a unit of time: s, ms, us, ns, or a number of seconds above 0 and up to 1.
/// @throws UsageError saying that
double seconds_of_unit(const std::string& text);

/// Finds out how points are timed, from some scans of a sequence. The unit is that under which the
/// points of a scan were taken within 2 ms to 1.9 s, unless a user says it.
/// @param unit s, ms, us, ns, or a number of seconds
/// @throws DataError if there is no field of times (naming those there are), if all points have one
///   time, if no unit fits, or if the type of the field has too few digits; UsageError for a bad
///   `unit`
PointClock find_point_clock(const std::vector<TimedScan>& scans,
                            const std::optional<std::string>& unit);

/// When the points of a scan were taken, in seconds from the time of the scan, for each point that
/// the scan has. @throws DataError for a time that is not finite or too far from that of the scan
std::vector<double> point_times(const TimedScan& timed, const PointClock& clock);

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
