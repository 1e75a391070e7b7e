// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <mutex>
#include <optional>
#include <string>

#include "core/scan/local_frame.h"

namespace raymoval {

/// The up direction in the world frame of a sequence's poses, and its source.
struct UpDirection {
  enum class Source {
    kWorldZ,     ///< The world's z axis: the scans do not clearly contradict it.
    kEstimated,  ///< By ground and upright surfaces of the scans, it is not z.
    kGiven,      ///< Given by the user.
  };
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< Unit vector, world frame.
  Source source = Source::kWorldZ;

  [[nodiscard]] bool is_world_z() const { return direction == Eigen::Vector3d::UnitZ(); }
};

/// A unit vector from `x`, `-y`, `z` and so on, or three numbers `x,y,z` of any length above 0;
/// empty for another text (see `kUpForm`).
std::optional<Eigen::Vector3d> parse_up(const std::string& text);

/// For messages.
inline constexpr const char* kUpForm =
    "expected an axis of the world (x, -x, y, -y, z or -z), or three numbers x,y,z, such as 0,-1,0";

/// "world z", "estimated" or "given".
const char* up_source_name(UpDirection::Source source);

/// "up is -y of the world (estimated from the scans; --up z overrules)"; empty if it is z.
std::string up_line(const UpDirection& up);

/// Evidence of the scans on gravity.
struct GravityEvidence {
  UpDirection up;
  /// Normal of the ground around the sensor; zero if no ground was found.
  Eigen::Vector3d ground = Eigen::Vector3d::Zero();
  /// The direction within 30 degrees of `ground` to which most upright surfaces (walls, trunks,
  /// sides of objects) are parallel.
  Eigen::Vector3d upright = Eigen::Vector3d::UnitZ();
  /// Upright share (within 2 degrees) of the area of surfaces that are not ground: if up is
  /// `upright`, and if up is the world axis nearest to `ground`.
  double share_upright = 0.0, share_axis = 0.0;
};

/// Estimates the up direction from the poses and up to eight evenly spaced scans.
///
/// The ground is the surface below the sensor that faces it in all scans. The mean z axis of the
/// sensor decides only between directions of similar support. If the ground does not face about
/// `usual`, `usual` is still up, unless one of these holds:
/// - hardly any floor is below the sensor at any distance, and no surface faces the ground;
/// - the path lies in a plane across the ground's direction, and there is less floor than ground;
/// - a surface faces the floor, and none faces the ground.
///
/// The ground may be a slope. So the ground selects an axis of the world, and upright surfaces
/// (walls, trunks, sides of objects) check that axis. The result is the axis nearest to the
/// ground's direction (`usual` if it is within 40 degrees), unless
/// - upright surfaces support a direction more than 8 degrees from it, 1.5 times as well as that
///   axis, or
/// - the ground as a whole is steeper than 30 degrees if that axis is up.
/// Then the result is the direction of the upright surfaces, completed by the ground's where these
/// do not constrain it. Without upright surfaces (a straight road on a slope), the axis is kept.
///
/// The result does not depend on the order of points. It rotates with the poses, up to rounding and
/// the choice of the axis.
/// @param usual unit vector, up unless the scans contradict it
/// @throws DataError if a scan cannot be read
GravityEvidence estimate_gravity(const ScanSource& scans,
                                 const Eigen::Vector3d& usual = Eigen::Vector3d::UnitZ());

/// The up direction given by the user, or an estimate that is made at the first `get`.
class UpChoice {
 public:
  explicit UpChoice(const std::optional<Eigen::Vector3d>& given);
  /// A known direction, without an estimate.
  explicit UpChoice(const UpDirection& known) : known_(known), up_(known) {}
  /// Thread-safe. @throws DataError if a scan cannot be read
  const UpDirection& get(const ScanSource& scans) const;
  /// The direction that was known from the start, or none.
  [[nodiscard]] const std::optional<UpDirection>& known() const { return known_; }

 private:
  std::optional<UpDirection> known_;
  mutable std::once_flag once_;
  mutable std::optional<UpDirection> up_;
};

}  // namespace raymoval
