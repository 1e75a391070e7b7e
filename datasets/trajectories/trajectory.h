// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
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
  /// The distance in time of the two poses around `stamp`. Nothing outside of the trajectory.
  [[nodiscard]] std::optional<Nanoseconds> gap_at(Nanoseconds stamp) const;

 private:
  std::vector<StampedPose> poses_;
};

/// Share `part` of a motion, which may be below 0 or above 1.
Pose part_of(const Pose& motion, double part);

/// The pose at share `t` (0 to 1) of the way from `a` to `b`.
Pose interpolated(const Pose& a, const Pose& b, double t);

}  // namespace raymoval
