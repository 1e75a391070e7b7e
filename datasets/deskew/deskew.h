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

/// How to interpret the times of the points of a sequence.
struct PointClock {
  /// The zero of the times.
  enum class Zero {
    kScanTime,    ///< The time of the scan.
    kClock,       ///< The zero of the clock of the scans' times.
    kFirstPoint,  ///< Another clock: the earliest point was taken at the time of the scan.
  };
  std::string field;    ///< Its name in the records.
  double unit_s = 1.0;  ///< Seconds per unit.
  Zero zero = Zero::kScanTime;
  std::string text;                ///< In words: "time in seconds from the time of the scan".
  double longest_s = 0.0;          ///< Seconds from the earliest to the latest point of a scan.
  std::vector<std::string> notes;  ///< Conclusions, in whole sentences.
};

/// A scan and its records.
struct TimedScan {
  Scan scan;
  PointRecords records;
  Nanoseconds stamp = 0;
  std::string place;  ///< For messages.
};

/// The seconds of a unit of time: s, ms, us, ns, or a number of seconds above 0 and up to 1.
/// @throws UsageError listing these forms
double seconds_of_unit(const std::string& text);

/// Determines the clock of the points from some scans of a sequence. Unless the user gives a unit,
/// it is the unit that gives a scan a duration of 2 ms to 1.9 s.
/// @param unit s, ms, us, ns, or a number of seconds
/// @throws DataError if there is no field of times (naming those there are), if all points have one
///   time, if no unit fits, or if the type of the field has too few digits; UsageError for a bad
///   `unit`
PointClock find_point_clock(const std::vector<TimedScan>& scans,
                            const std::optional<std::string>& unit);

/// The time of each point of a scan, in seconds from the time of the scan.
/// @throws DataError for a time that is not finite or too far from the time of the scan
std::vector<double> point_times(const TimedScan& timed, const PointClock& clock);

/// The input for the correction of motion within scans.
struct DeskewInput {
  std::shared_ptr<const RecordSource> records;
  std::shared_ptr<const SensorMotion> motion;
  std::vector<Nanoseconds> stamps;  ///< Of each scan, on the clock of `motion`.
  bool several_sensors = false;     ///< Whether `motion` is that of one sensor of several.
};

/// Determines the clock of the points from the first, middle and last scan of a sequence.
/// @throws DataError as `find_point_clock` and `load`
PointClock find_point_clock(const ScanSource& scans, const DeskewInput& input,
                            const std::optional<std::string>& unit);

/// Scans of another source, corrected for the motion of the sensor during the scan: each point is
/// in the sensor frame at the time of the scan. Poses are interpolated; shortly before the first
/// and after the last pose, the motion is extrapolated.
class DeskewedSource : public DerivedSource {
 public:
  DeskewedSource(std::shared_ptr<const ScanSource> whole, DeskewInput input, PointClock clock);

  /// @throws DataError also for a point whose time is not finite, or too far from the poses
  [[nodiscard]] Scan load(std::size_t index) const override;

  [[nodiscard]] const PointClock& clock() const { return clock_; }

 private:
  DeskewInput input_;
  PointClock clock_;
};

}  // namespace raymoval
