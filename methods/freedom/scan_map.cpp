// SPDX-License-Identifier: MIT
#include "methods/freedom/maps.h"

#include "core/scan/range_limits.h"

namespace raymoval::freedom_method {

void ScanMap::fill(const Scan& scan, const Parameters& parameters) {
  voxels_.clear();
  numbers_.clear();
  const double inverse = 1.0 / parameters.sub_voxel_size;
  const double voxels_a_metre = 1.0 / parameters.voxel_size();
  const RangeLimits ranges{parameters.minimum_range, parameters.maximum_range};
  std::uint32_t last = kNone;  // Consecutive points mostly share their voxel.
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d local = point.cast<double>();
    const Eigen::Vector3d from_sensor = scan.T_world_sensor.linear() * local;
    const double height = from_sensor.z();
    if (!ranges.contains(local.norm()) || height < parameters.lowest ||
        height > parameters.highest) {
      continue;
    }
    const Eigen::Vector3d world = from_sensor + scan.T_world_sensor.translation();
    const VoxelIndex sub_voxel = voxel_index(world, inverse);
    const VoxelIndex voxel = voxel_of(sub_voxel);
    if (last == kNone || voxels_[last].at != voxel) {
      const auto next = static_cast<std::uint32_t>(voxels_.size());
      const auto [found, is_new] = numbers_.try_emplace(voxel_key(voxel), next);
      if (is_new) voxels_.emplace_back().at = voxel;
      last = found->second;
    }
    voxels_[last].add(world * voxels_a_metre, place_of(sub_voxel));
  }
}

void ScanMap::grow() {
  std::vector<std::uint32_t> frontier;
  for (std::uint32_t i = 0; i < voxels_.size(); ++i) {
    if (voxels_[i].level == Level::kConservative) frontier.push_back(i);
  }
  for (const Level level : {Level::kModerate, Level::kAggressive, Level::kAggressive}) {
    std::vector<std::uint32_t> reached;
    for (const std::uint32_t from : frontier) {
      for_each_around(voxels_[from].at, 1, [&](const VoxelIndex& at) {
        const std::uint32_t to = find(at);
        if (to == kNone || voxels_[to].level != Level::kStatic) return;
        voxels_[to].level = level;
        reached.push_back(to);
      });
    }
    frontier = std::move(reached);
  }
}

}  // namespace raymoval::freedom_method
