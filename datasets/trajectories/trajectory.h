// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
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

/// A step from frame to frame: a fixed transform, or one over time.
struct MotionStep {
  Trajectory moving = {};                    ///< Used if the step is not fixed.
  std::optional<Pose> fixed = std::nullopt;  ///< At all times.
  bool inverse = false;                      ///< Whether the step goes the other way.
};

/// Where a sensor was over time, on the clock of its scans: the product of steps from the world to
/// the sensor, such as a body's trajectory and the place of the sensor on the body. Each step is
/// interpolated on its own, for their times differ. All calls are thread-safe.
class SensorMotion {
 public:
  /// @param time_offset what is added to the times of scans to get those of the poses
  /// @param max_gap poses further apart are not interpolated
  /// @param follows_scans whether the poses are just those of the scans, by their order: at the
  ///   times of the scans, which perhaps nobody knows
  explicit SensorMotion(std::vector<MotionStep> steps, Nanoseconds time_offset = 0,
                        Nanoseconds max_gap = kUsualMaxGap, bool follows_scans = false)
      : steps_(std::move(steps)),
        time_offset_(time_offset),
        max_gap_(max_gap),
        follows_scans_(follows_scans) {}

  /// T_world_sensor at `stamp`. Nothing before the first pose, after the last one, and in gaps.
  [[nodiscard]] std::optional<Pose> at(Nanoseconds stamp) const;
  /// This motion of a body, then a fixed step to a sensor on it.
  [[nodiscard]] SensorMotion followed_by(const Pose& T_body_sensor) const;
  /// The time in which all steps are known, on the clock of the scans.
  [[nodiscard]] std::pair<Nanoseconds, Nanoseconds> span() const;
  [[nodiscard]] Nanoseconds time_offset() const { return time_offset_; }
  [[nodiscard]] bool follows_scans() const { return follows_scans_; }

 private:
  std::vector<MotionStep> steps_;
  Nanoseconds time_offset_, max_gap_;
  bool follows_scans_;
};

/// That many scans have no pose, for what inspection says of it.
struct PoseGap {
  std::string where, what, remedy;
};

/// Half of the scans or more have no pose.
class PosesMissing : public DataError {
 public:
  explicit PosesMissing(PoseGap gap)
      : DataError(gap.where + ": " + gap.what + ". " + gap.remedy), gap_(std::move(gap)) {}
  [[nodiscard]] const PoseGap& gap() const { return gap_; }

 private:
  PoseGap gap_;
};

/// The poses of scans, and what a user should know of them.
struct FoundPoses {
  std::vector<std::optional<Pose>> poses;  ///< T_world_sensor of each scan; nothing if unknown.
  std::size_t missing = 0;                 ///< Scans without a pose.
  std::vector<std::string> losses;         ///< Whole sentences; none if every scan has its pose.
  std::optional<PoseGap> gap;              ///< If a quarter of the scans or more have no pose.
};

/// Looks up the pose of each scan. Scans that have none are to be left out, as long as they are
/// fewer than half.
/// @param stamps of the scans, in their order; at least one
/// @param where the poses are from, for messages: a path, or a bag and topic
/// @throws PosesMissing naming both ranges of time, and the --time-offset or --max-gap that would
///   help, if half of the scans or more have no pose
FoundPoses look_up_poses(const std::vector<Nanoseconds>& stamps, const SensorMotion& motion,
                         const std::string& where);

}  // namespace raymoval
