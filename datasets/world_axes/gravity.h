// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <optional>

#include "core/scan/scan_source.h"
#include "datasets/world_axes/up_direction.h"

namespace raymoval {

/// What the scans say about gravity.
struct GravityEvidence {
  UpDirection up;
  /// Direction that the ground around the sensor faces; zero if no ground was found.
  Eigen::Vector3d ground = Eigen::Vector3d::Zero();
  /// Direction that most upright surfaces (walls, trunks, sides of things) are parallel to, among
  /// those within 30 degrees of `ground`.
  Eigen::Vector3d upright = Eigen::Vector3d::UnitZ();
  /// Share of the area of surfaces that are not ground which stands upright (within 2 degrees)
  /// if up is `upright`, and if it is the world axis nearest to `ground`.
  double share_upright = 0.0, share_axis = 0.0;
};

/// Estimates which way is up from up to eight evenly spaced scans.
///
/// The ground is what lies below the sensor and faces it, in all scans alike; the mean z axis of
/// the sensor decides only between directions of like support. A slope is ground as well, so the
/// ground tells which axis of the world is meant, and upright surfaces (walls, trunks, sides of
/// things) tell whether that axis is wrong. The answer is the axis nearest to the ground's
/// direction (+z where z is within 40 degrees of it), unless
/// - upright surfaces agree on a direction more than 8 degrees from it, 1.5 times as well as on
///   that axis, or
/// - the ground as a whole is steeper than 30 degrees if that axis is up.
/// Then it is the direction that upright surfaces and, where these leave it open, the ground agree
/// on. Where nothing stands upright (a straight road on a slope and nothing else), the axis stays.
///
/// The answer does not depend on the order of points. It turns with the poses: their rotation
/// changes it by rounding only, apart from the choice of the axis.
/// @throws DataError if a scan cannot be read
GravityEvidence estimate_gravity(const ScanSource& scans);

/// What a user said about up, or the estimate, made when first asked for.
class UpChoice {
 public:
  explicit UpChoice(const std::optional<Eigen::Vector3d>& given);
  /// What is known already, so that nothing is estimated.
  explicit UpChoice(const UpDirection& known) : up_(known) {}
  /// Thread-safe. @throws DataError if a scan cannot be read
  const UpDirection& get(const ScanSource& scans) const;

 private:
  mutable std::once_flag once_;
  mutable std::optional<UpDirection> up_;
};

}  // namespace raymoval
