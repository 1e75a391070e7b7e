// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/dynablox/block_map.h"
#include "methods/dynablox/parameters.h"
#include "methods/dynablox/scan_voxels.h"

namespace raymoval::dynablox_method {

/// Points of a scan that move together.
struct Cluster {
  std::vector<std::uint32_t> points;                   ///< Of the scan, ascending.
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< World, metres.
  double extent = 0.0;                                 ///< Diagonal of the box around it, metres.
  int track = 0;  ///< Earlier scans through which it was followed.
};

/// Voxels with points that grew from ever-free ones.
struct GrownVoxels {
  std::vector<VoxelIndex> voxels;      ///< In an order that the order of points does not change.
  std::vector<std::uint32_t> cluster;  ///< Number of each voxel's cluster.
  std::vector<std::uint8_t> in_box;    ///< Whether the box of its cluster is around it too.
  VoxelMap<std::uint32_t> numbers;     ///< Position in `voxels`.
};

/// Step 3: what grows together from the ever-free voxels of a scan.
GrownVoxels grow_clusters(const ScanVoxels& scan, const BlockMap& map,
                          const Parameters& parameters);

/// Step 4: makes one number of the clusters that are near each other.
void merge_clusters(const Parameters& parameters, GrownVoxels& grown);

/// Steps 3 to 5: the clusters of a scan, those first whose points come first.
std::vector<Cluster> find_clusters(const Scan& scan, const ScanVoxels& voxels, const BlockMap& map,
                                   const Parameters& parameters);

/// Step 6: gives each cluster that goes on from one of the last scan's its track.
void follow_clusters(const std::vector<Cluster>& last, double most_distance,
                     std::vector<Cluster>& clusters);

}  // namespace raymoval::dynablox_method
