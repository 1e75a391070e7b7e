// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "methods/common/disjoint_sets.h"
#include "methods/dynablox/clusters.h"

namespace raymoval::dynablox_method {
namespace {

/// The steps between voxels whose centres are at most `separation` apart, but for none at all.
std::vector<VoxelIndex> steps_within(double separation, double voxel_size) {
  // 0.2 m is one voxel of 0.2 m, whatever the rounding.
  const double voxels = separation / voxel_size * (1.0 + 1e-9);
  const int most = static_cast<int>(voxels);
  std::vector<VoxelIndex> steps;
  for (int dz = -most; dz <= most; ++dz) {
    for (int dy = -most; dy <= most; ++dy) {
      for (int dx = -most; dx <= most; ++dx) {
        const VoxelIndex step(dx, dy, dz);
        const double square = step.cast<double>().squaredNorm();
        if (square > 0.0 && square <= voxels * voxels) steps.push_back(step);
      }
    }
  }
  return steps;
}

/// Calls `visit(i, j)` for each pair of voxels that are near each other.
template <class Visit>
void for_each_near_pair(const GrownVoxels& grown, const std::vector<VoxelIndex>& steps,
                        Visit&& visit) {
  for (std::size_t i = 0; i < grown.voxels.size(); ++i) {
    for (const VoxelIndex& step : steps) {
      const auto found = grown.numbers.find(voxel_key(grown.voxels[i] + step));
      if (found != grown.numbers.end()) visit(static_cast<std::uint32_t>(i), found->second);
    }
  }
}

/// A cluster as the public program merges it.
struct PublicCluster {
  VoxelIndex low, high;               ///< The box of its own voxels, ends included.
  std::vector<std::uint32_t> near;    ///< Clusters with voxels near its own, ascending.
  std::vector<std::uint32_t> merged;  ///< Itself, and those that it took in.
  bool is_gone = false;               ///< Another one took it in.
};

std::vector<PublicCluster> public_clusters(const GrownVoxels& grown,
                                           const std::vector<VoxelIndex>& steps) {
  std::vector<PublicCluster> clusters;
  for (std::size_t i = 0; i < grown.voxels.size(); ++i) {
    const VoxelIndex& voxel = grown.voxels[i];
    const std::uint32_t number = grown.cluster[i];
    if (number == clusters.size()) clusters.push_back({voxel, voxel, {}, {number}, false});
    clusters[number].low = clusters[number].low.cwiseMin(voxel);
    clusters[number].high = clusters[number].high.cwiseMax(voxel);
  }
  for_each_near_pair(grown, steps, [&](std::uint32_t i, std::uint32_t j) {
    if (grown.cluster[i] != grown.cluster[j]) {
      clusters[grown.cluster[i]].near.push_back(grown.cluster[j]);
    }
  });
  for (PublicCluster& cluster : clusters) {
    std::sort(cluster.near.begin(), cluster.near.end());
    cluster.near.erase(std::unique(cluster.near.begin(), cluster.near.end()), cluster.near.end());
  }
  return clusters;
}

/// Merges clusters in turn, with the public program's mistakes.
void merge_publicly(const Parameters& parameters, const std::vector<VoxelIndex>& steps,
                    GrownVoxels& grown) {
  std::vector<PublicCluster> clusters = public_clusters(grown, steps);
  const double reach = parameters.separation / parameters.voxel_size + 1.0;
  const auto may_be_near = [&](const PublicCluster& a, const PublicCluster& b) {
    return !parameters.public_boxes || a.low.z() <= b.high.x() + reach;
  };
  const auto is_near = [&](const PublicCluster& a, std::uint32_t b) {
    return std::binary_search(a.near.begin(), a.near.end(), b);
  };
  for (std::uint32_t i = 0; i < clusters.size(); ++i) {
    PublicCluster& one = clusters[i];
    if (one.is_gone) continue;
    for (std::uint32_t j = i + 1; j < clusters.size(); ++j) {
      PublicCluster& other = clusters[j];
      if (other.is_gone || !is_near(one, j) || !may_be_near(one, other)) continue;
      other.is_gone = true;
      one.merged.push_back(j);
      if (parameters.public_merges) continue;
      one.low = one.low.cwiseMin(other.low);
      one.high = one.high.cwiseMax(other.high);
      std::vector<std::uint32_t> near;
      std::set_union(one.near.begin(), one.near.end(), other.near.begin(), other.near.end(),
                     std::back_inserter(near));
      one.near = std::move(near);
      j = i;  // All that are left are compared again.
    }
  }
  std::vector<std::uint32_t> number(clusters.size());
  for (std::uint32_t i = 0; i < clusters.size(); ++i) {
    if (clusters[i].is_gone) continue;
    for (const std::uint32_t j : clusters[i].merged) number[j] = i;
  }
  for (std::size_t i = 0; i < grown.cluster.size(); ++i) {
    const std::uint32_t own = std::exchange(grown.cluster[i], number[grown.cluster[i]]);
    grown.in_box[i] = !parameters.public_merges || own == grown.cluster[i] ? 1 : 0;
  }
}

}  // namespace

void merge_clusters(const Parameters& parameters, GrownVoxels& grown) {
  const std::vector<VoxelIndex> steps = steps_within(parameters.separation, parameters.voxel_size);
  if (parameters.public_boxes || parameters.public_merges) {
    merge_publicly(parameters, steps, grown);
    return;
  }
  DisjointSets sets(grown.cluster.size());  // There are no more clusters than voxels.
  for_each_near_pair(grown, steps, [&](std::uint32_t i, std::uint32_t j) {
    sets.join(grown.cluster[i], grown.cluster[j]);
  });
  for (std::uint32_t& cluster : grown.cluster) cluster = sets.root(cluster);
}

}  // namespace raymoval::dynablox_method
