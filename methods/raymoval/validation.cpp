// SPDX-License-Identifier: MIT
#include "methods/raymoval/validation.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/sampling.h"
#include "methods/common/disjoint_sets.h"
#include "methods/common/range_adaptive_clusters.h"

namespace raymoval::raymoval_method {
namespace {

/// A voxel and the first of the elements in it.
using FirstElement = std::pair<VoxelKey, std::uint32_t>;

/// The voxels in ascending order, each with one of its elements; elements of one voxel are joined.
std::vector<FirstElement> sorted_voxels(const std::vector<VoxelKey>& voxels, DisjointSets& sets) {
  std::vector<FirstElement> sorted;
  sorted.reserve(voxels.size());
  for (std::uint32_t i = 0; i < voxels.size(); ++i) {
    if (i > 0 && voxels[i] == voxels[i - 1]) {
      sets.join(i - 1, i);  // Neighbours often share a voxel.
    } else {
      sorted.emplace_back(voxels[i], i);
    }
  }
  std::sort(sorted.begin(), sorted.end());
  const auto same = [&](const FirstElement& a, const FirstElement& b) {
    if (a.first != b.first) return false;
    sets.join(a.second, b.second);
    return true;
  };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  return sorted;
}

/// Joins each voxel with those at offsets (-gap .. gap, y, z). Sorted voxels run along x, so that
/// one pass with two positions finds them.
void join_rows(const std::vector<FirstElement>& sorted, int y, int z, int gap, DisjointSets& sets) {
  const VoxelKey offset = voxel_key(0, y, z) - voxel_key(0, 0, 0);
  const auto reach = static_cast<VoxelKey>(gap);
  std::size_t low = 0;
  for (const auto& [key, element] : sorted) {
    const VoxelKey middle = key + offset;
    while (low < sorted.size() && sorted[low].first + reach < middle) ++low;
    for (std::size_t k = low; k < sorted.size() && sorted[k].first <= middle + reach; ++k) {
      sets.join(element, sorted[k].second);
    }
  }
}

std::size_t at(int member) {
  return static_cast<std::size_t>(member);
}

double median_range(const std::vector<int>& members, const ScanPoints& points) {
  std::vector<double> values;
  for (const int member : members) values.push_back(points.range[at(member)]);
  return median(std::move(values));
}

Extent extent_of(const std::vector<int>& members, const ScanPoints& points) {
  Extent extent;
  for (const int member : members) extent.add(points.position[at(member)]);
  return extent;
}

/// Sides of the voxels' common box, so that one layer of voxels is one voxel thick.
double thinnest_voxel_side(const std::vector<int>& members, const ScanPoints& points,
                           double voxel_size) {
  VoxelIndex low = points.voxel[at(members.front())], high = low;
  for (const int member : members) {
    low = low.cwiseMin(points.voxel[at(member)]);
    high = high.cwiseMax(points.voxel[at(member)]);
  }
  return ((high - low).minCoeff() + 1) * voxel_size;
}

/// m_min and d_min: whether a cluster's remainder is large enough to be an object.
bool is_large_enough(const std::vector<int>& cluster, const ScanPoints& points,
                     const Parameters& parameters) {
  return static_cast<int>(cluster.size()) >= parameters.minimum_points &&
         extent_of(cluster, points).width() >= parameters.minimum_width;
}

/// Eqs 14-15: 1 for each member of a group that is dynamic.
Mask check_groups(const std::vector<int>& group_of, const ScanPoints& points,
                  const OccupancyMap& static_map, const Parameters& parameters) {
  Mask in_dynamic_group(points.size(), 0);
  for (const std::vector<int>& group : members_of(group_of)) {
    const double covered = coverage(group, points, static_map, parameters.coverage_dilation);
    const double thinnest = thinnest_voxel_side(group, points, static_map.voxel_size());
    if (belongs_to_static(covered, thinnest, parameters)) continue;
    for (const int member : group) in_dynamic_group[at(member)] = 1;
  }
  return in_dynamic_group;
}

/// The chosen elements of `points`.
ScanPoints subset(const ScanPoints& points, const std::vector<int>& chosen) {
  ScanPoints part;
  for (const int i : chosen) {
    part.position.push_back(points.position[at(i)]);
    part.voxel.push_back(points.voxel[at(i)]);
    part.range.push_back(points.range[at(i)]);
  }
  return part;
}

std::vector<VoxelKey> keys_of(const std::vector<VoxelIndex>& voxels) {
  std::vector<VoxelKey> keys;
  keys.reserve(voxels.size());
  for (const VoxelIndex& voxel : voxels) keys.push_back(voxel_key(voxel));
  return keys;
}

}  // namespace

std::vector<int> voxel_components(const std::vector<VoxelKey>& voxels, int gap) {
  DisjointSets sets(voxels.size());
  const std::vector<FirstElement> sorted = sorted_voxels(voxels, sets);
  for (int z = 0; z <= gap; ++z) {
    for (int y = z == 0 ? 0 : -gap; y <= gap; ++y) join_rows(sorted, y, z, gap, sets);
  }
  return sets.numbers();
}

std::vector<int> joined_groups(const std::vector<int>& cluster_of,
                               const std::vector<int>& component_of) {
  DisjointSets components(component_of.size());
  const auto component = [&](std::size_t i) { return static_cast<std::uint32_t>(component_of[i]); };
  const int last =
      cluster_of.empty() ? -1 : *std::max_element(cluster_of.begin(), cluster_of.end());
  std::vector<int> first_component(static_cast<std::size_t>(last + 1), -1);
  for (std::size_t i = 0; i < cluster_of.size(); ++i) {
    int& first = first_component[static_cast<std::size_t>(cluster_of[i])];
    if (first < 0) first = component_of[i];
    components.join(static_cast<std::uint32_t>(first), component(i));
  }
  std::vector<int> group(component_of.size());
  for (std::size_t i = 0; i < group.size(); ++i) {
    group[i] = static_cast<int>(components.root(component(i)));
  }
  return group;
}

std::vector<std::vector<int>> members_of(const std::vector<int>& numbers) {
  std::vector<std::vector<int>> members;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = static_cast<std::size_t>(numbers[i]);
    if (number >= members.size()) members.resize(number + 1);
    members[number].push_back(static_cast<int>(i));
  }
  std::erase_if(members, [](const std::vector<int>& set) { return set.empty(); });
  return members;
}

double cluster_points_at(double range, const Parameters& parameters) {
  const double shrink = 10.0 / std::max(range, 1.0);
  return std::max(3.0, parameters.cluster_points * shrink * shrink);
}

bool passes_cluster_screen(const std::vector<int>& members, const ScanPoints& points,
                           const Parameters& parameters) {
  const double range = median_range(members, points);
  return static_cast<double>(members.size()) >= cluster_points_at(range, parameters) &&
         extent_of(members, points).width() >= parameters.cluster_width;
}

double coverage(const std::vector<int>& members, const ScanPoints& points,
                const OccupancyMap& static_map, int dilation) {
  int inside = 0;
  VoxelMap<bool> near;  // Points share voxels.
  near.reserve(members.size());
  for (const int member : members) {
    const VoxelIndex& voxel = points.voxel[at(member)];
    const auto [found, is_new] = near.try_emplace(voxel_key(voxel), false);
    if (is_new) found.value() = static_map.contains_near(voxel, dilation);
    inside += found->second ? 1 : 0;
  }
  return members.empty() ? 0.0 : inside / static_cast<double>(members.size());
}

bool belongs_to_static(double group_coverage, double thinnest_side, const Parameters& parameters) {
  constexpr double kRounding = 1e-9;  // Sides are multiples of the voxel size.
  return group_coverage >= parameters.coverage_static ||
         (group_coverage >= parameters.coverage_edge &&
          thinnest_side <= parameters.thin_side + kRounding);
}

double support(const VoxelIndex& voxel, const OccupancyMap& static_map, const OccupancyMap& removed,
               int dilation) {
  const VoxelIndex low = voxel.array() - dilation, high = voxel.array() + dilation;
  const Eigen::Vector3i first = OccupancyMap::brick_of(low), last = OccupancyMap::brick_of(high);
  int in_map = 0, in_removed = 0;
  for (int z = first.z(); z <= last.z(); ++z) {
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int x = first.x(); x <= last.x(); ++x) {
        const Brick* kept = static_map.find_brick({x, y, z});
        const Brick* gone = removed.find_brick({x, y, z});
        if (kept == nullptr && gone == nullptr) continue;
        const BrickPart part = BrickPart::within({x, y, z}, low, high);
        for (int word = part.first_word; word <= part.last_word; ++word) {
          const auto at = static_cast<std::size_t>(word);
          const std::uint64_t map_bits = kept == nullptr ? 0 : kept->occupied[at] & part.mask;
          const std::uint64_t removed_bits = gone == nullptr ? 0 : gone->occupied[at] & part.mask;
          in_map += std::popcount(map_bits);
          in_removed += std::popcount(removed_bits & ~map_bits);
        }
      }
    }
  }
  return in_map + in_removed == 0 ? 0.0 : static_cast<double>(in_map) / (in_map + in_removed);
}

std::vector<int> unsupported_members(const std::vector<int>& cluster, const ScanPoints& points,
                                     const OccupancyMap& static_map, const Parameters& parameters) {
  if (parameters.support_share >= 1.0) return cluster;  // No member is supported, as documented.
  OccupancyMap removed(static_map.voxel_size());
  for (const int member : cluster) removed.insert(points.voxel[at(member)]);
  std::vector<int> unsupported;
  VoxelMap<double> support_of;  // Points share voxels.
  for (const int member : cluster) {
    const VoxelIndex& voxel = points.voxel[at(member)];
    const auto [found, is_new] = support_of.try_emplace(voxel_key(voxel), 0.0);
    if (is_new) {
      found.value() = support(voxel, static_map, removed, parameters.support_dilation);
    }
    if (found.value() < parameters.support_share) unsupported.push_back(member);
  }
  return unsupported;
}

Mask validate_candidates(const ScanPoints& candidates, const OccupancyMap& static_map,
                         const Parameters& parameters) {
  const std::vector<int> cluster_numbers = range_adaptive_clusters(
      candidates.position, candidates.range, parameters.cluster_gap, parameters.cluster_gap_growth);
  Mask passes(candidates.size(), 0);
  for (const std::vector<int>& cluster : members_of(cluster_numbers)) {
    if (!passes_cluster_screen(cluster, candidates, parameters)) continue;
    for (const int member : cluster) passes[at(member)] = 1;
  }
  std::vector<int> screened;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (passes[i] != 0) screened.push_back(static_cast<int>(i));
  }
  const ScanPoints points = subset(candidates, screened);
  std::vector<int> cluster_of;
  for (const int i : screened) cluster_of.push_back(cluster_numbers[at(i)]);
  const std::vector<int> group_of =
      joined_groups(cluster_of, voxel_components(keys_of(points.voxel), parameters.group_gap));
  const Mask in_dynamic_group = check_groups(group_of, points, static_map, parameters);
  Mask dynamic(candidates.size(), 0);
  for (const std::vector<int>& cluster : members_of(cluster_of)) {
    // All members of a cluster are in one group.
    if (in_dynamic_group[at(cluster.front())] == 0) continue;
    const std::vector<int> rest = unsupported_members(cluster, points, static_map, parameters);
    if (!is_large_enough(rest, points, parameters)) continue;
    for (const int member : rest) dynamic[at(screened[at(member)])] = 1;
  }
  return dynamic;
}

}  // namespace raymoval::raymoval_method
