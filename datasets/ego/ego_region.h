// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>

namespace raymoval {

/// The part of the sensor frame (metres) whose points belong to the machine that carries the
/// sensor: points there go along with it, and methods take them for things that are always there.
struct EgoRegion {
  enum class Kind {
    kNone,       ///< No point is left out.
    kEstimated,  ///< To be found in the scans, see `estimate_ego`.
    kRadius,     ///< Points nearer than `radius`.
    kBox,        ///< Points within `box`, its faces included.
  };
  Kind kind = Kind::kNone;
  double radius = 0.0;
  Eigen::AlignedBox3d box;

  /// Whether a point of the sensor frame lies in it; never for the first two kinds.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const {
    if (kind == Kind::kRadius) return point.squaredNorm() < radius * radius;
    return kind == Kind::kBox && box.contains(point);
  }
};

/// Reads "none", "auto" (estimated), a radius ("2.4"), or a box ("-1:2,-0.9:0.9,-1.5:0.2" along x,
/// y and z of the sensor frame, an empty side open). @throws UsageError saying what the forms are
EgoRegion parse_ego_region(const std::string& text);

/// What `parse_ego_region` reads.
std::string ego_region_text(const EgoRegion& region);

}  // namespace raymoval
