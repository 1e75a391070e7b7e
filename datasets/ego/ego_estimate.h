// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/voxel_key.h"
#include "datasets/ego/ego_region.h"
#include "datasets/geometry/surfels.h"

namespace raymoval {

/// Edge of the cells of an estimate, metres.
inline constexpr double kEgoCell = 0.25;

/// The part of the scans that moves along with the sensor: the ego vehicle, or another machine.
struct EgoEstimate {
  std::size_t scans = 0;  ///< Number of compared scans, a metre or more apart.
  std::size_t steady =
      0;         ///< Number of cells of the sensor frame that are occupied in nearly all scans.
  VoxelSet own;  ///< Cells of the machine.

  /// Whether the sensor moved enough for an estimate.
  [[nodiscard]] bool has_enough_motion() const { return scans >= 5; }
  /// Whether a machine was found. Fewer cells may be chance.
  [[nodiscard]] bool found() const { return has_enough_motion() && own.size() >= 4; }
  /// Whether `point` (sensor frame) lies in a cell of the machine.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const;
  /// The box around the cells of the machine with a margin for noise; of kind kNone if none was
  /// found.
  [[nodiscard]] EgoRegion region() const;
};

/// Chooses poses that are a metre or more apart from all earlier chosen poses; a turn by 20 degrees
/// counts as a metre. The result has at most `most` poses, evenly chosen.
/// @param candidates positions in `poses`, ascending
std::vector<std::size_t> poses_apart(const std::vector<Pose>& poses,
                                     const std::vector<std::size_t>& candidates, std::size_t most);

/// Finds the points that are fixed in the sensor frame while the sensor moves. A wall or a guard
/// rail along the way is fixed as well, but it begins farther from the sensor or extends farther
/// than a vehicle. Points within 0.4 m of the ground or of a ceiling are ignored, because these are
/// fixed as well.
/// @param scans scans apart, see `poses_apart`
/// @param surfels of each of `scans`, see `find_surfels`, without surfels of the machine
/// @param world_up up in the world frame, a unit vector
EgoEstimate estimate_ego(const std::vector<const Scan*>& scans,
                         const std::function<const std::vector<Surfel>&(std::size_t)>& surfels,
                         const Eigen::Vector3d& world_up);

}  // namespace raymoval
