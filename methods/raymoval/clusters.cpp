// SPDX-License-Identifier: MIT
#include "methods/raymoval/clusters.h"

#include <algorithm>

#include "methods/common/disjoint_sets.h"

namespace raymoval::raymoval_method {
namespace {

/// Calls `visit(key)` for each cell within `reach` cells of `cell`, itself included.
template <class Visit>
void for_neighbours(const VoxelIndex& cell, int reach, Visit&& visit) {
  for (int dz = -reach; dz <= reach; ++dz) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        visit(voxel_key(cell.x() + dx, cell.y() + dy, cell.z() + dz));
      }
    }
  }
}

}  // namespace

std::vector<int> voxel_components(const std::vector<VoxelKey>& voxels, int gap) {
  DisjointSets sets(voxels.size());
  VoxelMap<std::uint32_t> seen;
  for (std::uint32_t i = 0; i < voxels.size(); ++i) {
    const auto [first, is_new] = seen.emplace(voxels[i], i);
    if (!is_new) sets.join(i, first->second);
  }
  for (const auto& [voxel, element] : seen) {
    for_neighbours(voxel_index(voxel), gap, [&, own = voxel, i = element](VoxelKey key) {
      if (key <= own) return;  // Every pair once.
      const auto found = seen.find(key);
      if (found != seen.end()) sets.join(i, found->second);
    });
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

}  // namespace raymoval::raymoval_method
