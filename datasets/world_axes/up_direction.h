// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

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

}  // namespace raymoval
