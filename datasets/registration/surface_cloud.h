// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/scan/scan.h"

namespace raymoval::registration {

/// A point on a flat piece of surface, in the sensor frame.
struct SurfacePoint {
  Eigen::Vector3f position;  ///< Metres; on the plane.
  Eigen::Vector3f normal;    ///< Unit length, towards the sensor.

  [[nodiscard]] float operator()(unsigned axis) const { return position[axis]; }
};

inline const Eigen::Vector3f& position_of(const SurfacePoint& point) {
  return point.position;
}

/// The flat surfaces of a scan as points, at most one per cubic cell of 0.256 m.
///
/// Surfaces are the patches of `for_each_patch`. Points nearer than a quarter of the scan's median
/// range are left out, because they may be of the ego vehicle. Points beyond 60 m are left out too.
class SurfaceCloud {
 public:
  explicit SurfaceCloud(const Scan& scan);
  ~SurfaceCloud();
  SurfaceCloud(SurfaceCloud&&) noexcept;

  [[nodiscard]] const std::vector<SurfacePoint>& points() const;
  /// The point nearest to `position` (sensor frame), or null if none is within `reach` metres.
  [[nodiscard]] const SurfacePoint* nearest(const Eigen::Vector3f& position, float reach) const;
  /// Median range of all points of the scan, metres; 0 for a scan without points.
  [[nodiscard]] double median_range() const { return median_range_; }

 private:
  struct Tree;
  double median_range_ = 0.0;
  std::unique_ptr<Tree> tree_;
};

}  // namespace raymoval::registration
