// SPDX-License-Identifier: MIT
#include "methods/raymoval/clusters.h"

#include <algorithm>
#include <utility>

#include "methods/common/disjoint_sets.h"

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

/// Joins each voxel with those that lie (-gap .. gap, y, z) cells from it. Sorted voxels run along
/// x, so that one pass with two marks finds them.
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

}  // namespace raymoval::raymoval_method
