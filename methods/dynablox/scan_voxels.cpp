// SPDX-License-Identifier: MIT
#include "methods/dynablox/scan_voxels.h"

namespace raymoval::dynablox_method {

void VoxelHits::add(const VoxelIndex& voxel) {
  const VoxelIndex at = block_of(voxel);
  if (blocks_.empty() || at != last_at_) {
    const auto [found, is_new] =
        numbers_.try_emplace(voxel_key(at), static_cast<std::uint32_t>(blocks_.size()));
    if (is_new) blocks_.emplace_back();
    last_at_ = at;
    last_ = found->second;
  }
  std::uint16_t& row = blocks_[last_][row_of(voxel)];
  row = static_cast<std::uint16_t>(row | bit_of(voxel));
}

void find_voxels(const Scan& scan, double voxel_size, double min_range, double max_range,
                 ScanVoxels& found) {
  found.points.clear();
  found.voxels.clear();
  found.hits.clear();
  const double inverse = 1.0 / voxel_size;
  const double least = min_range * min_range, most = max_range * max_range;
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const Eigen::Vector3f& point = scan.points[k];
    // In double precision a square of a single one is exact, so that the bounds are.
    const double square = point.cast<double>().squaredNorm();
    if (!(square >= least && square <= most)) continue;
    const VoxelIndex voxel = voxel_index(scan.T_world_sensor * point.cast<double>(), inverse);
    found.points.push_back(static_cast<std::uint32_t>(k));
    found.voxels.push_back(voxel);
    found.hits.add(voxel);
  }
}

}  // namespace raymoval::dynablox_method
