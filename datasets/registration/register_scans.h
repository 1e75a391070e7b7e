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

/// How well two scans fit under a motion, before and after registration. Metres.
struct Registration {
  Pose T_from_to = Pose::Identity();  ///< Registered.
  std::size_t matched = 0;            ///< Surface points with a counterpart, after registration.
  double overlap = 0.0;  ///< Share of the surface points of `to` on a surface of `from`, 0 to 1.
  double overlap_of_guess = 0.0;  ///< The same under the guess.
  /// Overlaps of the points on surfaces across the way from the guess; 0 if there are few.
  double overlap_across = 0.0, overlap_across_of_guess = 0.0;
  double noise = 0.0;  ///< Robust standard deviation of distances after registration.
  double shift = 0.0;  ///< RMS along the normals by which registration moved the surfaces.
  double shift_of_points = 0.0;  ///< The same in any direction.
};

/// Registers `to` to `from`, starting from a guess of T_from_to with an error of up to about 3 m
/// and 10 degrees. Point to plane (Chen and Medioni 1992), Gauss-Newton with Tukey's weights,
/// counterparts with similar normals only. Motions that the surfaces do not constrain, such as
/// along a tunnel, are not changed. At most 1,500 points of `to` are used.
/// @param others further guesses with an error of up to about 1 m, for scans that may be far off
Registration register_scans(const SurfaceCloud& from, const SurfaceCloud& to, const Pose& guess,
                            const std::vector<Pose>& others = {});

}  // namespace raymoval::registration
