// SPDX-License-Identifier: MIT
#include "methods/dynablox/voxels.h"

#include <algorithm>
#include <utility>

#include "methods/common/disjoint_sets.h"

namespace raymoval::dynablox_method {
namespace {

/// Voxels with points, grown from ever-free voxels.
struct GrownVoxels {
  std::vector<VoxelIndex> voxels;
  VoxelMap<std::uint32_t> numbers;  ///< Position in `voxels`.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joins;

  std::uint32_t add(const VoxelIndex& voxel) {
    const auto number = static_cast<std::uint32_t>(voxels.size());
    const auto [found, is_new] = numbers.try_emplace(voxel_key(voxel), number);
    if (is_new) voxels.push_back(voxel);
    return found->second;
  }
};

/// Step 3: the ever-free voxels with points of the scan, and their neighbours with points.
GrownVoxels grow(const ScanVoxels& scan, const BlockMap& map) {
  GrownVoxels grown;
  BlockFinder blocks(map);
  for (const VoxelIndex& voxel : scan.voxels) {
    const Block* block = blocks.find(block_of(voxel));
    if (block != nullptr && contains(block->ever_free, voxel)) grown.add(voxel);
  }
  BlockFinder hits(scan.hits);
  const std::vector<VoxelIndex> seeds = grown.voxels;
  for (std::uint32_t i = 0; i < seeds.size(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        VoxelIndex beside = seeds[i];
        beside[axis] += step;
        const BlockBits* hit = hits.find(block_of(beside));
        if (hit != nullptr && contains(*hit, beside))
          grown.joins.emplace_back(i, grown.add(beside));
      }
    }
  }
  return grown;
}

/// Step 4: joins clusters if centres of their voxels are near each other.
void join_near(const GrownVoxels& grown, const Parameters& parameters, DisjointSets& sets) {
  // 0.2 m is one voxel of 0.2 m, despite rounding.
  const double voxels = parameters.separation / parameters.voxel_size * (1.0 + 1e-9);
  std::vector<VoxelIndex> steps;
  for_each_around(VoxelIndex::Zero(), static_cast<int>(voxels), [&](const VoxelIndex& step) {
    if (step.cast<double>().squaredNorm() <= voxels * voxels) steps.push_back(step);
  });
  for (std::uint32_t i = 0; i < grown.voxels.size(); ++i) {
    for (const VoxelIndex& step : steps) {
      const auto found = grown.numbers.find(voxel_key(grown.voxels[i] + step));
      if (found != grown.numbers.end()) sets.join(i, found->second);
    }
  }
}

}  // namespace

std::vector<Cluster> find_clusters(const ScanVoxels& scan, const BlockMap& map,
                                   const Parameters& parameters) {
  const GrownVoxels grown = grow(scan, map);
  if (grown.voxels.empty()) return {};
  DisjointSets sets(grown.voxels.size());
  for (const auto& [a, b] : grown.joins) sets.join(a, b);
  join_near(grown, parameters, sets);
  std::vector<Cluster> clusters(grown.voxels.size());
  for (std::uint32_t k = 0; k < scan.voxels.size(); ++k) {
    const auto found = grown.numbers.find(voxel_key(scan.voxels[k]));
    if (found != grown.numbers.end()) clusters[sets.root(found->second)].push_back(k);
  }
  std::erase_if(clusters, [&](const Cluster& cluster) {  // Step 5.
    return cluster.size() < static_cast<std::size_t>(parameters.min_points);
  });
  return clusters;
}

}  // namespace raymoval::dynablox_method
