// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <mutex>
#include <optional>
#include <string>

#include "core/scan/scan_source.h"

namespace raymoval {

/// Which way is up in the world frame of a sequence's poses, and how that is known.
struct UpDirection {
  enum class Source {
    kWorldZ,     ///< The world's z axis: the scans do not clearly say otherwise.
    kEstimated,  ///< Ground and upright surfaces of the scans say that it is not z.
    kGiven,      ///< A user said so.
  };
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< Unit vector, world frame.
  Source source = Source::kWorldZ;

  [[nodiscard]] bool is_world_z() const { return direction == Eigen::Vector3d::UnitZ(); }
};

/// A unit vector from `x`, `-y`, `z` and so on, or three numbers `x,y,z` of any length above 0;
/// nothing for another text (see `kUpForm`).
std::optional<Eigen::Vector3d> parse_up(const std::string& text);

/// For messages.
inline constexpr const char* kUpForm =
    "expected an axis of the world (x, -x, y, -y, z or -z), or three numbers x,y,z, such as 0,-1,0";

/// "-y" for an axis, else "0.000,0.342,0.940".
std::string up_text(const Eigen::Vector3d& up);

/// "world z", "estimated" or "given".
const char* up_source_name(UpDirection::Source source);

/// "up is -y of the world (estimated from the scans; --up z overrules)"; empty where it is z.
std::string up_line(const UpDirection& up);

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

/// Estimates which way is up from the poses and up to eight evenly spaced scans.
///
/// The ground is what lies below the sensor and faces it, in all scans alike; the mean z axis of
/// the sensor decides only between directions of like support. If the ground does not face about
/// `usual`, that is up all the same, unless hardly any floor lies below the sensor at whatever
/// distance and nothing faces the ground, or the path lies in a plane across the ground's direction
/// and there is less floor than ground, or something faces the floor and nothing the ground.
///
/// A slope is ground as well, so the ground tells which axis of the world is meant, and upright
/// surfaces (walls, trunks, sides of things) tell whether that axis is wrong. The answer is the
/// axis nearest to the ground's direction (`usual` where that is within 40 degrees of it), unless
/// - upright surfaces agree on a direction more than 8 degrees from it, 1.5 times as well as on
///   that axis, or
/// - the ground as a whole is steeper than 30 degrees if that axis is up.
/// Then it is the direction that upright surfaces and, where these leave it open, the ground agree
/// on. Where nothing stands upright (a straight road on a slope and nothing else), the axis stays.
///
/// The answer does not depend on the order of points. It turns with the poses: their rotation
/// changes it by rounding only, apart from the choice of the axis.
/// @param usual unit vector, the direction that is up unless the scans contradict it
/// @throws DataError if a scan cannot be read
GravityEvidence estimate_gravity(const ScanSource& scans,
                                 const Eigen::Vector3d& usual = Eigen::Vector3d::UnitZ());

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
