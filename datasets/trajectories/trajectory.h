// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval {

/// A point in time, or a length of time, in nanoseconds. Times since 1970 keep every digit, which
/// they would not as a double of seconds (0.2 microseconds).
using Nanoseconds = std::int64_t;

/// Stamps that are read from data lie between this and its negative (139 years), so that sums and
/// differences of them with a shift of a clock do not overflow.
inline constexpr Nanoseconds kMostStamp = 4'400'000'000'000'000'000;
/// The same for shifts of a clock (63 years).
inline constexpr Nanoseconds kMostOffset = 2'000'000'000'000'000'000;

/// "1317384506.4000001" as nanoseconds, exactly. Digits behind the ninth place are rounded. Nothing
/// if it is no number, or beyond `kMostStamp`.
std::optional<Nanoseconds> parse_stamp(std::string_view text);
/// Seconds with nine decimals: "1317384506.400000100".
std::string stamp_text(Nanoseconds stamp);
/// @param seconds finite and within 292 years of 0
Nanoseconds from_seconds(double seconds);
double to_seconds(Nanoseconds time);

/// A pose and when the body had it.
struct StampedPose {
  Nanoseconds stamp = 0;
  Pose T_world_body = Pose::Identity();
};

/// Poses over time: straight lines between positions, the shortest turn at an even pace (slerp)
/// between attitudes.
class Trajectory {
 public:
  Trajectory() = default;
  /// @param poses in order of their stamps, each later than the one before
  /// @throws InternalError if they are not
  explicit Trajectory(std::vector<StampedPose> poses);

  [[nodiscard]] const std::vector<StampedPose>& poses() const { return poses_; }
  [[nodiscard]] bool empty() const { return poses_.empty(); }

  /// The pose at `stamp`. Nothing before the first pose or after the last one (nothing is ever
  /// extrapolated), and nothing between two poses that are further apart than `max_gap`, unless one
  /// of them has just this stamp.
  [[nodiscard]] std::optional<Pose> at(Nanoseconds stamp, Nanoseconds max_gap) const;

 private:
  std::vector<StampedPose> poses_;
};

/// Share `part` of a motion, which may be below 0 or above 1.
Pose part_of(const Pose& motion, double part);

/// The pose at share `t` (0 to 1) of the way from `a` to `b`.
Pose interpolated(const Pose& a, const Pose& b, double t);

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
