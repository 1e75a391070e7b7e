// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdlib>
#include <limits>

#include "methods/raymoval_plus/common/parameters.h"

namespace raymoval::raymoval_plus_method {

/// What step 7 knows of a cluster of one scan; world frame, metres.
struct ObjectSummary {
  /// Bounding box.
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< Mean of the points.
  double time_s = 0.0;                               ///< Of its scan.
  float range = 0.0F;                                ///< Distance of the centre from the sensor.
  /// The number of scans that agree with a point, on average over the points that are not dynamic.
  float agree_scans = 0.0F;
  /// Of these points also: the number of scans that saw through, and the numbers of the first and
  /// the last scan that agree, on average.
  float free_scans = 0.0F;
  double first_agree = 0.0, last_agree = 0.0;
  int points = 0;
  int dynamic = 0;            ///< How many points are dynamic.
  int firm = 0;
  float score = 0.0F, outside = 0.0F;
  bool is_part = false;
  bool is_whole = false;      ///< The others stand on these, see `Cluster::is_whole`.
  bool is_undivided = false;  ///< It was divided, and so stands beside what it was divided into.
  int cluster = 0;            ///< Number within its scan.

  [[nodiscard]] double width() const { return (high - low).head<2>().norm(); }
};

/// Whether a cluster, or what is remembered of it, is one dynamic thing: whole, or with enough of
/// its points dynamic.
template <class Thing>
bool is_one_dynamic_thing(const Thing& thing, const Parameters& parameters) {
  const double share = thing.is_part ? parameters.part_score : parameters.object_score;
  static const double kThing = getenv("THING") ? atof(getenv("THING")) : 1e9;
  static const double kFewer = getenv("FEWER") ? atof(getenv("FEWER")) : -1;
  if (thing.outside >= kThing * thing.points) return true;
  if (thing.outside < kFewer * thing.points) return false;
  return thing.firm <= parameters.firm_share * thing.points &&
         (static_cast<double>(thing.score) >= parameters.sure_score * thing.points ||
          (static_cast<double>(thing.score) >= share * thing.points &&
           thing.dynamic >= parameters.object_dynamic_share * thing.points));
}

/// Whether an object is one dynamic thing and has enough dynamic points for its track to take it
/// for one, which then has no need to mark it.
/// @note A part of a divided cluster goes by itself only with `group_points` dynamic points. One
/// with fewer, but `object_points` of them, neither goes as a whole nor is marked by itself; a
/// track may still mark the cluster that it was divided from.
inline bool is_dynamic(const ObjectSummary& object, const Parameters& parameters) {
  static const double kThing = getenv("THING") ? atof(getenv("THING")) : 1e9;
  if (object.points >= parameters.object_points && object.outside >= kThing * object.points) return true;
  return object.dynamic >= parameters.object_points && is_one_dynamic_thing(object, parameters);
}

}  // namespace raymoval::raymoval_plus_method
