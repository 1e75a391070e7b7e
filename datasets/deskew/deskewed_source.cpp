// SPDX-License-Identifier: MIT
#include "datasets/deskew/deskewed_source.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/trajectories/trajectory.h"

namespace raymoval {
namespace {

/// Where a sensor was around the time of one scan.
class MotionAround {
 public:
  MotionAround(const SensorMotion& motion, Nanoseconds stamp, double longest_s, std::string place)
      : motion_(motion),
        stamp_(stamp),
        step_(std::max<Nanoseconds>(from_seconds(longest_s), 1)),
        place_(std::move(place)) {
    const auto pose = motion.at(stamp);
    if (!pose) throw InternalError(place_ + " has no pose");
    T_sensor_world_ = pose->inverse();
  }

  /// Takes points as seen `seconds` after the time of the scan to that time.
  [[nodiscard]] const Pose& since(double seconds) {
    if (known_ && seconds == last_) return moved_;
    last_ = seconds;
    known_ = true;
    moved_ = T_sensor_world_ * pose_at(stamp_ + from_seconds(seconds));
    return moved_;
  }

 private:
  [[nodiscard]] Pose pose_at(Nanoseconds time) const {
    if (const auto pose = motion_.at(time)) return *pose;
    const auto [first, last] = motion_.span();
    // Within a gap between poses the last time that is known is that of the scan.
    const Nanoseconds known = time < first ? first : time > last ? last : stamp_;
    const Nanoseconds beyond = time - known;
    if (std::abs(beyond) > step_ + step_ / 2) {
      throw DataError(place_ + ": has points " + stamp_text(beyond) +
                      " s from the nearest pose that is known, which is more than the time of a "
                      "scan. Take a trajectory that covers the scan, or leave it out (--frames).");
    }
    const Pose at_known = motion_.at(known).value();
    // The motion over the step before, or after if there is none before.
    for (const Nanoseconds step : {beyond > 0 ? -step_ : step_, beyond > 0 ? step_ : -step_}) {
      const Nanoseconds other = std::clamp(known + step, first, last);
      const auto pose = motion_.at(other);
      if (!pose || other == known) continue;
      const double part = static_cast<double>(beyond) / static_cast<double>(other - known);
      return at_known * part_of(at_known.inverse() * *pose, part);
    }
    return at_known;  // A single pose: the sensor stands.
  }

  const SensorMotion& motion_;
  Nanoseconds stamp_;
  Nanoseconds step_;  ///< The time that a scan takes.
  std::string place_;
  Pose T_sensor_world_ = Pose::Identity();
  bool known_ = false;
  double last_ = 0.0;
  Pose moved_ = Pose::Identity();
};

}  // namespace

PointClock find_point_clock(const ScanSource& scans, const DeskewInput& input,
                            const std::optional<std::string>& unit) {
  const std::size_t count = scans.size();
  std::vector<TimedScan> timed;
  for (const std::size_t i : std::set<std::size_t>{0, count / 2, count - 1}) {
    timed.push_back(
        {scans.load(i), input.records->records(i), input.stamps[i], input.records->place(i)});
  }
  PointClock clock = find_point_clock(timed, unit);
  const auto [first, last] = input.motion->span();
  bool beyond = false;
  for (const TimedScan& scan : timed) {
    for (const double time : point_times(scan, clock)) {
      const Nanoseconds stamp = scan.stamp + from_seconds(time);
      beyond = beyond || stamp < first || stamp > last;
    }
  }
  if (beyond && first < last) {
    clock.notes.push_back(
        "--deskew: points that were taken before the first or after the last pose are moved as the "
        "sensor moved next to it.");
  }
  return clock;
}

DeskewedSource::DeskewedSource(std::shared_ptr<const ScanSource> whole, DeskewInput input,
                               PointClock clock)
    : whole_(std::move(whole)), input_(std::move(input)), clock_(std::move(clock)) {
  if (input_.stamps.size() != whole_->size()) {
    throw InternalError("scans and their times differ in number");
  }
}

Scan DeskewedSource::load(std::size_t index) const {
  TimedScan timed{whole_->load(index), input_.records->records(index), input_.stamps.at(index),
                  input_.records->place(index)};
  const std::vector<double> times = point_times(timed, clock_);
  MotionAround motion(*input_.motion, timed.stamp, clock_.longest_s, timed.place);
  for (std::size_t i = 0; i < times.size(); ++i) {
    Eigen::Vector3f& point = timed.scan.points[i];
    point = (motion.since(times[i]) * point.cast<double>()).cast<float>();
  }
  return std::move(timed.scan);
}

}  // namespace raymoval
