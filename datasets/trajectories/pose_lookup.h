// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/trajectories/trajectory.h"

namespace raymoval {

/// Poses that are further apart in time are not interpolated, unless a user says otherwise.
inline constexpr Nanoseconds kUsualMaxGap = 1'000'000'000;

/// Where a sensor was over time, on the clock of its scans. All calls are thread-safe.
class SensorMotion {
 public:
  virtual ~SensorMotion() = default;
  /// T_world_sensor at `stamp`. Nothing before the first pose, after the last one, and in gaps.
  [[nodiscard]] virtual std::optional<Pose> at(Nanoseconds stamp) const = 0;
  /// The times of the first and the last pose, on the clock of the scans.
  [[nodiscard]] virtual std::pair<Nanoseconds, Nanoseconds> span() const = 0;
  /// What is added to the times of scans to get those of the poses.
  [[nodiscard]] virtual Nanoseconds time_offset() const { return 0; }
  /// Whether its poses are just those of the scans, by their order: at the times of the scans,
  /// which perhaps nobody knows.
  [[nodiscard]] virtual bool follows_scans() const { return false; }
};

/// A body's trajectory and a sensor on that body.
struct BodyMotion {
  Trajectory trajectory;                  ///< At least one pose.
  Pose T_body_sensor = Pose::Identity();  ///< Takes points of the sensor to the body.
  Nanoseconds time_offset = 0;            ///< Added to the times of scans.
  Nanoseconds max_gap = kUsualMaxGap;     ///< Poses further apart are not interpolated.
  bool follows_scans = false;             ///< See `SensorMotion`.
};

/// The motion of a sensor that is fixed on a body.
class TrajectoryMotion : public SensorMotion {
 public:
  /// @throws InternalError if there is no pose
  explicit TrajectoryMotion(BodyMotion body);
  [[nodiscard]] std::optional<Pose> at(Nanoseconds stamp) const override;
  [[nodiscard]] std::pair<Nanoseconds, Nanoseconds> span() const override;
  [[nodiscard]] Nanoseconds time_offset() const override { return body_.time_offset; }
  [[nodiscard]] bool follows_scans() const override { return body_.follows_scans; }

 private:
  BodyMotion body_;
};

/// The poses of scans, and what a user should know of them.
struct FoundPoses {
  std::vector<std::optional<Pose>> poses;  ///< T_world_sensor of each scan; nothing if unknown.
  std::size_t missing = 0;                 ///< Scans without a pose.
  std::vector<std::string> losses;         ///< Whole sentences; none if every scan has its pose.
};

/// Looks up the pose of each scan. Scans that have none are to be left out, as long as they are
/// fewer than half.
/// @param stamps of the scans, in their order; at least one
/// @param where the poses are from, for messages: a path, or a bag and topic
/// @throws DataError naming both ranges of time, and the --time-offset or --max-gap that would
///   help, if half of the scans or more have no pose
FoundPoses look_up_poses(const std::vector<Nanoseconds>& stamps, const SensorMotion& motion,
                         const std::string& where);

}  // namespace raymoval
