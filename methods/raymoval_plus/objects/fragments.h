// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/raymoval_plus/objects/objects.h"

namespace raymoval::raymoval_plus_method {

/// Whether a cluster of so many points is a fragment: a head or a bumper of which few rays hit
/// anything, and no object of its own.
inline bool is_fragment(int points, const Parameters& parameters) {
  return points <= parameters.object_points;
}

/// The points of a scan's fragments. They go with an object that goes beside them.
class Fragments {
 public:
  Fragments(const SegmentedScan& scan, const Parameters& parameters);

  /// Calls `visit(point)` with the number of each point that is near the box of an object.
  template <class Visit>
  void for_near(const ObjectSummary& object, Visit&& visit) const {
    for (const Point& point : points_) {
      const Eigen::Vector3d apart =
          (object.low - point.place).cwiseMax(point.place - object.high).cwiseMax(0.0);
      if (apart.squaredNorm() <= point.reach * point.reach) visit(point.number);
    }
  }

 private:
  struct Point {
    std::uint32_t number;   ///< In the scan.
    Eigen::Vector3d place;  ///< World frame, metres.
    double reach;           ///< Metres.
  };
  std::vector<Point> points_;
};

}  // namespace raymoval::raymoval_plus_method
