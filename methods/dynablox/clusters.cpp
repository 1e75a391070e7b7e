// SPDX-License-Identifier: MIT
#include "methods/dynablox/clusters.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "methods/common/disjoint_sets.h"
#include "methods/dynablox/free_space.h"

namespace raymoval::dynablox_method {
namespace {

/// The ever-free voxels in which the scan has points, by their keys.
std::vector<VoxelKey> find_seeds(const ScanVoxels& scan, const BlockMap& map) {
  std::vector<VoxelKey> seeds;
  LastBlock<const BlockMap, const Block> blocks(map);
  for (const VoxelIndex& voxel : scan.voxels) {
    const Block* block = blocks.find(block_of(voxel));
    if (block == nullptr || !block->is_ever_free(voxel)) continue;
    seeds.push_back(voxel_key(voxel));
  }
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  return seeds;
}

/// Step 5.
bool has_size(const Cluster& cluster, const Parameters& parameters) {
  const auto points = static_cast<double>(cluster.points.size());
  return points >= parameters.min_points && points <= parameters.max_points &&
         cluster.extent >= parameters.min_extent && cluster.extent <= parameters.max_extent;
}

/// The boxes around the voxels of clusters, metres.
/// @param place of each number that `grown` gives to clusters: its position among them
std::vector<Eigen::AlignedBox3d> boxes_around_voxels(const GrownVoxels& grown,
                                                     const std::vector<std::uint32_t>& place,
                                                     double voxel_size, std::size_t clusters) {
  std::vector<Eigen::AlignedBox3d> boxes(clusters);
  for (std::size_t i = 0; i < grown.voxels.size(); ++i) {
    if (grown.in_box[i] == 0) continue;
    const Eigen::Vector3d low = grown.voxels[i].cast<double>() * voxel_size;
    boxes[place[grown.cluster[i]]].extend(low).extend(low + Eigen::Vector3d::Constant(voxel_size));
  }
  return boxes;
}

}  // namespace

GrownVoxels grow_clusters(const ScanVoxels& scan, const BlockMap& map,
                          const Parameters& parameters) {
  GrownVoxels grown;
  const auto add = [&grown](const VoxelIndex& voxel) {
    const auto number = static_cast<std::uint32_t>(grown.voxels.size());
    const auto [found, is_new] = grown.numbers.try_emplace(voxel_key(voxel), number);
    if (is_new) grown.voxels.push_back(voxel);
    return found->second;
  };
  for (const VoxelKey seed : find_seeds(scan, map)) add(voxel_index(seed));
  const std::vector<VoxelIndex> steps = steps_to(parameters.cluster_neighbours);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joins;
  std::size_t begin = 0;
  // From the ever-free voxels first, then from those beside them.
  for (int round = 0; round < (parameters.grow_twice ? 2 : 1); ++round) {
    const std::size_t end = grown.voxels.size();
    for (std::size_t i = begin; i < end; ++i) {
      const VoxelIndex from = grown.voxels[i];
      for (const VoxelIndex& step : steps) {
        const VoxelIndex to = from + step;
        if (!scan.hits.contains(to)) continue;
        if (parameters.public_unmapped && map.find(block_of(to)) == nullptr) continue;
        joins.emplace_back(static_cast<std::uint32_t>(i), add(to));
      }
    }
    begin = end;
  }
  DisjointSets sets(grown.voxels.size());
  for (const auto& [a, b] : joins) sets.join(a, b);
  for (const int number : sets.numbers()) {
    grown.cluster.push_back(static_cast<std::uint32_t>(number));
  }
  grown.in_box.assign(grown.voxels.size(), 1);
  return grown;
}

std::vector<Cluster> find_clusters(const Scan& scan, const ScanVoxels& voxels, const BlockMap& map,
                                   const Parameters& parameters) {
  GrownVoxels grown = grow_clusters(voxels, map, parameters);
  if (grown.voxels.empty()) return {};
  merge_clusters(parameters, grown);
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> place(grown.voxels.size(), kNone);  // Of each number.
  std::vector<Cluster> clusters;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (std::size_t i = 0; i < voxels.points.size(); ++i) {
    const auto found = grown.numbers.find(voxel_key(voxels.voxels[i]));
    if (found == grown.numbers.end()) continue;
    std::uint32_t& at = place[grown.cluster[found->second]];
    if (at == kNone) {
      at = static_cast<std::uint32_t>(clusters.size());
      clusters.emplace_back();
      boxes.emplace_back();
    }
    const std::uint32_t point = voxels.points[i];
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[point].cast<double>();
    clusters[at].points.push_back(point);
    clusters[at].centroid += world;
    boxes[at].extend(world);
  }
  if (parameters.extents == Extents::kVoxels) {
    boxes = boxes_around_voxels(grown, place, parameters.voxel_size, clusters.size());
  }
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    clusters[i].centroid /= static_cast<double>(clusters[i].points.size());
    clusters[i].extent = boxes[i].diagonal().norm();
  }
  std::erase_if(clusters, [&](const Cluster& cluster) { return !has_size(cluster, parameters); });
  return clusters;
}

void follow_clusters(const std::vector<Cluster>& last, double most_distance,
                     std::vector<Cluster>& clusters) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < last.size(); ++i) {
    for (std::size_t j = 0; j < clusters.size(); ++j) {
      const double distance = (last[i].centroid - clusters[j].centroid).norm();
      if (distance <= most_distance) pairs.emplace_back(distance, i, j);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<bool> is_last_taken(last.size(), false), is_taken(clusters.size(), false);
  for (const auto& [distance, i, j] : pairs) {
    if (is_last_taken[i] || is_taken[j]) continue;
    is_last_taken[i] = is_taken[j] = true;
    clusters[j].track = last[i].track + 1;
  }
}

}  // namespace raymoval::dynablox_method
