// SPDX-License-Identifier: MIT
#include "methods/raymoval/validation.h"

#include <algorithm>

namespace raymoval {
namespace {

std::size_t at(int member) {
  return static_cast<std::size_t>(member);
}

double median_range(const std::vector<int>& members, const std::vector<double>& ranges) {
  std::vector<double> values;
  for (const int member : members) values.push_back(ranges[at(member)]);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Extent extent_of(const std::vector<int>& members, const WeightedPoints& points) {
  Extent extent;
  for (const int member : members) extent.add(points.position[at(member)]);
  return extent;
}

/// Sides of the voxels' common box, so that one layer of voxels is one voxel thick.
double thinnest_voxel_side(const std::vector<int>& members, const WeightedPoints& points,
                           double voxel_size) {
  VoxelIndex low = points.voxel[at(members.front())], high = low;
  for (const int member : members) {
    low = low.cwiseMin(points.voxel[at(member)]);
    high = high.cwiseMax(points.voxel[at(member)]);
  }
  return ((high - low).minCoeff() + 1) * voxel_size;
}

/// Members that stay dynamic of a cluster in a dynamic group: the unsupported ones, if enough.
std::vector<int> unsupported_members(const std::vector<int>& cluster, const WeightedPoints& points,
                                     const OccupancyMap& static_map,
                                     const RaymovalParameters& parameters) {
  std::vector<int> kept;
  double weight = 0.0;
  for (const int member : cluster) {
    const bool supported =
        static_map.contains_near(points.voxel[at(member)], parameters.support_dilation);
    if (supported) continue;
    kept.push_back(member);
    weight += points.weight[at(member)];
  }
  const bool enough = !kept.empty() && weight >= parameters.minimum_points &&
                      extent_of(kept, points).width() >= parameters.minimum_width;
  return enough ? kept : std::vector<int>{};
}

/// Eqs 14-15 on each group, then the unsupported members of each of its clusters.
Mask validate_groups(const std::vector<int>& cluster_of, const std::vector<int>& group_of,
                     const WeightedPoints& points, const OccupancyMap& static_map,
                     const RaymovalParameters& parameters) {
  Mask in_dynamic_group(points.size(), 0);
  for (const std::vector<int>& group : members_of(group_of)) {
    const double covered = coverage(group, points, static_map, parameters.coverage_dilation);
    const double thinnest = thinnest_voxel_side(group, points, static_map.voxel_size());
    if (belongs_to_static(covered, thinnest, parameters)) continue;
    for (const int member : group) in_dynamic_group[at(member)] = 1;
  }
  Mask dynamic(points.size(), 0);
  for (const std::vector<int>& cluster : members_of(cluster_of)) {
    // All members of a cluster are in one group.
    if (in_dynamic_group[at(cluster.front())] == 0) continue;
    for (const int member : unsupported_members(cluster, points, static_map, parameters)) {
      dynamic[at(member)] = 1;
    }
  }
  return dynamic;
}

/// The chosen elements of `points`.
WeightedPoints subset(const WeightedPoints& points, const std::vector<int>& chosen) {
  WeightedPoints part;
  for (const int i : chosen) {
    part.position.push_back(points.position[at(i)]);
    part.voxel.push_back(points.voxel[at(i)]);
    part.weight.push_back(points.weight[at(i)]);
  }
  return part;
}

std::vector<VoxelKey> keys_of(const std::vector<VoxelIndex>& voxels) {
  std::vector<VoxelKey> keys;
  for (const VoxelIndex& voxel : voxels) keys.push_back(voxel_key(voxel));
  return keys;
}

/// Joins clusters that have voxels in common components: numbers of the merged groups by member.
std::vector<int> merge_into_groups(const std::vector<int>& cluster_of,
                                   const std::vector<int>& component_of) {
  // Clusters and components together are a graph with one edge a member; its connected parts are
  // the groups. A few sweeps settle it, since components are local.
  std::vector<int> group = component_of;
  bool changed = true;
  while (changed) {
    changed = false;
    for (const auto* numbers : {&cluster_of, &component_of}) {
      for (const std::vector<int>& members : members_of(*numbers)) {
        int lowest = group[at(members.front())];
        for (const int member : members) lowest = std::min(lowest, group[at(member)]);
        for (const int member : members) {
          changed |= group[at(member)] != lowest;
          group[at(member)] = lowest;
        }
      }
    }
  }
  return group;
}

}  // namespace

double cluster_points_at(double range, const RaymovalParameters& parameters) {
  const double shrink = 10.0 / std::max(range, 1.0);
  return std::max(3.0, parameters.cluster_points * shrink * shrink);
}

double cluster_width_at(double /*range*/, const RaymovalParameters& parameters) {
  return parameters.cluster_width;
}

bool passes_cluster_screen(const std::vector<int>& members, const WeightedPoints& points,
                           const std::vector<double>& ranges,
                           const RaymovalParameters& parameters) {
  const double range = median_range(members, ranges);
  return static_cast<double>(members.size()) >= cluster_points_at(range, parameters) &&
         extent_of(members, points).width() >= cluster_width_at(range, parameters);
}

double coverage(const std::vector<int>& members, const WeightedPoints& points,
                const OccupancyMap& static_map, int dilation) {
  double inside = 0.0, total = 0.0;
  for (const int member : members) {
    total += points.weight[at(member)];
    if (static_map.contains_near(points.voxel[at(member)], dilation)) {
      inside += points.weight[at(member)];
    }
  }
  return total > 0.0 ? inside / total : 0.0;
}

bool belongs_to_static(double group_coverage, double thinnest_side,
                       const RaymovalParameters& parameters) {
  constexpr double kRounding = 1e-9;  // Sides are multiples of the voxel size.
  return group_coverage >= parameters.coverage_static ||
         (group_coverage >= parameters.coverage_edge &&
          thinnest_side <= parameters.thin_side + kRounding);
}

Mask validate_candidates(const WeightedPoints& candidates, const std::vector<double>& ranges,
                         const OccupancyMap& static_map, const RaymovalParameters& parameters) {
  std::vector<int> screened;
  const std::vector<int> all_clusters = range_adaptive_clusters(
      candidates.position, ranges, parameters.cluster_gap, parameters.cluster_gap_growth);
  for (const std::vector<int>& cluster : members_of(all_clusters)) {
    if (passes_cluster_screen(cluster, candidates, ranges, parameters)) {
      screened.insert(screened.end(), cluster.begin(), cluster.end());
    }
  }
  std::sort(screened.begin(), screened.end());
  const WeightedPoints points = subset(candidates, screened);
  std::vector<int> cluster_of;
  for (const int i : screened) cluster_of.push_back(all_clusters[at(i)]);
  const std::vector<int> group_of =
      merge_into_groups(cluster_of, voxel_components(keys_of(points.voxel), parameters.group_gap));
  const Mask valid = validate_groups(cluster_of, group_of, points, static_map, parameters);
  Mask dynamic(candidates.size(), 0);
  for (std::size_t i = 0; i < screened.size(); ++i) dynamic[at(screened[i])] = valid[i];
  return dynamic;
}

Mask validate_removed_voxels(const WeightedPoints& voxels, const OccupancyMap& static_map,
                             const RaymovalParameters& parameters) {
  const std::vector<VoxelKey> keys = keys_of(voxels.voxel);
  return validate_groups(voxel_components(keys, 1), voxel_components(keys, parameters.group_gap),
                         voxels, static_map, parameters);
}

}  // namespace raymoval
