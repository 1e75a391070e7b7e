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

/// A point in time, or a duration, in nanoseconds. Times since 1970 keep every digit; a double of
/// seconds would round to 0.2 microseconds.
using Nanoseconds = std::int64_t;

/// Limit of the magnitude of stamps (139 years), so that sums and differences with a clock offset
/// do not overflow.
inline constexpr Nanoseconds kMostStamp = 4'400'000'000'000'000'000;
/// Limit of the magnitude of clock offsets (63 years).
inline constexpr Nanoseconds kMostOffset = 2'000'000'000'000'000'000;

/// "1317384506.4000001" as nanoseconds, exactly. Digits behind the ninth place are rounded. Empty
/// if it is no number, or beyond `kMostStamp`.
std::optional<Nanoseconds> parse_stamp(std::string_view text);
/// Seconds with nine decimals: "1317384506.400000100".
std::string stamp_text(Nanoseconds stamp);
/// @param seconds finite and within 292 years of 0
Nanoseconds from_seconds(double seconds);
double to_seconds(Nanoseconds time);

/// A pose and its time.
struct StampedPose {
  Nanoseconds stamp = 0;
  Pose T_world_body = Pose::Identity();
};

/// Poses over time, interpolated linearly in position and by slerp in rotation.
class Trajectory {
 public:
  Trajectory() = default;
  /// @param poses with strictly ascending stamps
  /// @throws InternalError if they are not
  explicit Trajectory(std::vector<StampedPose> poses);

  [[nodiscard]] const std::vector<StampedPose>& poses() const { return poses_; }
  [[nodiscard]] bool empty() const { return poses_.empty(); }

  /// The pose at `stamp`. Empty before the first and after the last pose (no extrapolation), and
  /// between two poses more than `max_gap` apart, unless a pose has exactly this stamp.
  [[nodiscard]] std::optional<Pose> at(Nanoseconds stamp, Nanoseconds max_gap) const;

 private:
  std::vector<StampedPose> poses_;
};

/// The fraction `part` of a motion; it may be below 0 or above 1.
Pose part_of(const Pose& motion, double part);

/// The pose at fraction `t` (0 to 1) of the way from `a` to `b`.
Pose interpolated(const Pose& a, const Pose& b, double t);

/// Default of the longest gap between poses that is interpolated.
inline constexpr Nanoseconds kUsualMaxGap = 1'000'000'000;

/// A step from frame to frame: a fixed transform, or one over time.
struct MotionStep {
  Trajectory moving = {};                    ///< Used if the step is not fixed.
  std::optional<Pose> fixed = std::nullopt;  ///< At all times.
  bool inverse = false;                      ///< Whether the inverse is used.
};

/// The pose of a sensor over time, on the clock of its scans: the product of steps from the world
/// to the sensor, such as a body's trajectory and the pose of the sensor on the body. Each step is
/// interpolated separately, because their times differ. All calls are thread-safe.
class SensorMotion {
 public:
  /// @param time_offset added to the times of scans to get the times of poses
  /// @param max_gap longest gap between poses that is interpolated
  /// @param follows_scans whether the poses are assigned to the scans by order: at the times of the
  ///   scans, which may be unknown
  explicit SensorMotion(std::vector<MotionStep> steps, Nanoseconds time_offset = 0,
                        Nanoseconds max_gap = kUsualMaxGap, bool follows_scans = false)
      : steps_(std::move(steps)),
        time_offset_(time_offset),
        max_gap_(max_gap),
        follows_scans_(follows_scans) {}

  /// T_world_sensor at `stamp`. Empty before the first pose, after the last pose, and in gaps.
  [[nodiscard]] std::optional<Pose> at(Nanoseconds stamp) const;
  /// This motion of a body, then steps to a sensor on it.
  [[nodiscard]] SensorMotion followed_by(const std::vector<MotionStep>& steps) const;
  /// The time span in which all steps are known, on the clock of the scans.
  [[nodiscard]] std::pair<Nanoseconds, Nanoseconds> span() const;
  [[nodiscard]] Nanoseconds time_offset() const { return time_offset_; }
  [[nodiscard]] bool follows_scans() const { return follows_scans_; }

 private:
  std::vector<MotionStep> steps_;
  Nanoseconds time_offset_, max_gap_;
  bool follows_scans_;
};

/// Data on many scans without a pose, for inspection.
struct PoseGap {
  std::string where, what, remedy;
};

/// Thrown if half of the scans or more have no pose.
class PosesMissing : public DataError {
 public:
  explicit PosesMissing(PoseGap gap)
      : DataError(gap.where + ": " + gap.what + ". " + gap.remedy), gap_(std::move(gap)) {}
  [[nodiscard]] const PoseGap& gap() const { return gap_; }

 private:
  PoseGap gap_;
};

/// The poses of scans, with messages for the user.
struct FoundPoses {
  std::vector<std::optional<Pose>> poses;  ///< T_world_sensor of each scan; empty if unknown.
  std::size_t missing = 0;                 ///< Scans without a pose.
  std::vector<std::string> losses;         ///< Whole sentences; none if every scan has its pose.
  std::optional<PoseGap> gap;              ///< Set if a quarter of the scans or more have no pose.
};

/// Looks up the pose of each scan. The caller leaves out scans without a pose.
/// @param stamps of the scans, in their order; at least one
/// @param where source of the poses, for messages: a path, or a bag and topic
/// @throws PosesMissing naming both time ranges, and a helpful --time-offset or --max-gap, if half
///   of the scans or more have no pose
FoundPoses look_up_poses(const std::vector<Nanoseconds>& stamps, const SensorMotion& motion,
                         const std::string& where);

}  // namespace raymoval
