// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>

#include "methods/raymoval_plus/common/parameters.h"

namespace raymoval::raymoval_plus_method {

/// Sums over the points of an object, of what is known of their voxels.
struct ObjectEvidence {
  int dynamic = 0;             ///< How many points are dynamic.
  float contradiction = 0.0F;  ///< See `contradiction`.
  float passes = 0.0F;         ///< See `VoxelEvidence::passes_outside`.
};

/// What step 7 knows of a cluster of one scan; world frame, metres.
struct ObjectSummary {
  /// Bounding box.
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< Mean of the points.
  double time_s = 0.0;                               ///< Of its scan.
  float range = 0.0F;                                ///< Distance of the centre from the sensor.
  /// Means over the points that are not dynamic: the number of scans that hit a point's voxel, and
  /// the numbers of the first and the last one.
  float hits = 0.0F;
  double first_hit = 0.0, last_hit = 0.0;
  int points = 0;
  ObjectEvidence evidence;
  int cluster = 0;  ///< Number within its scan.

  [[nodiscard]] double width() const { return (high - low).head<2>().norm(); }
};

/// Whether a cluster, or what is remembered of it, is one dynamic thing: enough beams passed where
/// it is, before it came or after it left.
template <class Thing>
bool is_dynamic(const Thing& thing, const Parameters& parameters) {
  const double points = thing.points;
  const ObjectEvidence& evidence = thing.evidence;
  if (thing.points < parameters.object_points) return false;
  if (evidence.passes >= parameters.object_passes * points) return true;
  return evidence.passes >= parameters.object_least_passes * points &&
         evidence.contradiction >= parameters.object_contradiction * points;
}

}  // namespace raymoval::raymoval_plus_method
