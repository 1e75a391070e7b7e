// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/common/thinned_points.h"
#include "methods/mapcleaner/range_image.h"
#include "methods/remover.h"

namespace raymoval::mapcleaner_method {

/// The votes of scans on voxels: each scan compares the centroids of voxels around it with its
/// range image, and votes for voxels that it sees and against voxels that it sees through.
class VoxelVotes {
 public:
  /// @param voxels must outlive this object
  VoxelVotes(const Parameters& parameters, const ThinnedPoints& voxels, const SensorModel& sensor);

  /// Adds a scan's votes. Scans must be given in order, because the voxels around a sensor are only
  /// updated now and then. The result does not depend on `context.threads`.
  void add(const Scan& scan, const RunContext& context);
  /// Whether more scans see through a voxel than see it.
  [[nodiscard]] bool is_dynamic(std::size_t voxel) const { return balance_[voxel] > 0; }
  /// The number of scans that see through a voxel minus the number that see it.
  [[nodiscard]] int balance(std::size_t voxel) const { return balance_[voxel]; }

 private:
  /// Voxels of an upright square column of the world.
  struct Tile {
    Eigen::Vector3d low, high;       ///< The box around their centroids, metres.
    std::size_t begin = 0, end = 0;  ///< Their indices in `by_tile_`.
  };
  /// The voxels around a place, with their centroids relative to it, metres.
  struct Submap {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    std::vector<std::uint32_t> voxel;
    std::vector<float> x, y, z;
  };

  void sort_into_tiles();
  void choose_submap(const Eigen::Vector3d& place);
  /// Votes on the submap's voxels from `begin` to `end`, at most a batch.
  void vote(const Eigen::Isometry3f& T_sensor_submap, std::size_t begin, std::size_t end);

  double radius_, travel_;
  const ThinnedPoints& voxels_;
  RangeImage image_;
  std::vector<std::uint32_t> by_tile_;  ///< Voxels, tile by tile.
  std::vector<Tile> tiles_;
  bool has_submap_ = false;
  Submap submap_;
  std::vector<std::int32_t> balance_;
};

}  // namespace raymoval::mapcleaner_method
