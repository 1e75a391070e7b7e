// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/voxel_key.h"
#include "datasets/ego/ego_region.h"
#include "datasets/geometry/surfels.h"

namespace raymoval {

/// Edge of the cells that an estimate looks at, metres.
inline constexpr double kEgoCell = 0.25;

/// The part of the scans that goes along with the sensor.
struct EgoEstimate {
  std::size_t scans = 0;  ///< How many were compared; they are a metre or more apart.
  std::size_t steady =
      0;         ///< How many cells of the sensor frame are occupied in nearly all of them.
  VoxelSet own;  ///< Those of them that belong to the machine at the sensor.

  /// Whether the sensor moved enough to tell.
  [[nodiscard]] bool can_tell() const { return scans >= 5; }
  /// Whether something goes along with it: a few cells alone may be chance.
  [[nodiscard]] bool found() const { return can_tell() && own.size() >= 4; }
  /// Whether `point` (sensor frame) lies in a cell of the machine.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const;
  /// The box around these cells with some room for noise; of kind kNone if nothing was found.
  [[nodiscard]] EgoRegion region() const;
};

/// Of `poses`, those between which the sensor went a metre or more, a turn by 20 degrees counting
/// as one: the first, and each that is so far from all before it; at most `most`, evenly chosen.
/// @param candidates positions in `poses`, ascending
std::vector<std::size_t> poses_apart(const std::vector<Pose>& poses,
                                     const std::vector<std::size_t>& candidates, std::size_t most);

/// Finds the points that keep their place in the sensor frame while the sensor moves. A wall or a
/// guard rail along the way does so too, but it begins farther from the sensor or goes on; a
/// vehicle ends. Nothing is found within 0.4 m of the ground and of a ceiling, which keep their
/// place as well.
/// @param scans scans apart, see `poses_apart`
/// @param surfels of each of `scans`, see `find_surfels`, without those of the machine itself
EgoEstimate estimate_ego(const std::vector<const Scan*>& scans,
                         const std::function<const std::vector<Surfel>&(std::size_t)>& surfels);

}  // namespace raymoval
