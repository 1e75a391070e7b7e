// SPDX-License-Identifier: MIT
#include "methods/raymoval/clusters.h"

#include <algorithm>
#include <numeric>

namespace raymoval {
namespace {

/// Disjoint sets; the root of a set is its lowest element, so numbers do not depend on join order.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int root(int element) {
    while (parent_[at(element)] != element) {
      parent_[at(element)] = parent_[at(parent_[at(element)])];
      element = parent_[at(element)];
    }
    return element;
  }
  void join(int a, int b) {
    const int root_a = root(a), root_b = root(b);
    parent_[at(std::max(root_a, root_b))] = std::min(root_a, root_b);
  }
  /// Sets numbered in order of their first element.
  std::vector<int> numbers() {
    std::vector<int> number(parent_.size());
    int next = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      const int element = static_cast<int>(i);
      const int found = root(element);
      number[i] = found == element ? next++ : number[at(found)];
    }
    return number;
  }

 private:
  static std::size_t at(int element) { return static_cast<std::size_t>(element); }
  std::vector<int> parent_;
};

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

std::vector<int> range_adaptive_clusters(const std::vector<Eigen::Vector3d>& points,
                                         const std::vector<double>& ranges, double gap,
                                         double growth) {
  DisjointSets sets(points.size());
  if (points.empty()) return {};
  // Cells as wide as the widest gap: partners of a point are in its own cell or a neighbouring one.
  const double widest = gap + growth * *std::max_element(ranges.begin(), ranges.end());
  const double scale = 1.0 / std::max(widest, 1e-3);
  VoxelMap<std::vector<int>> cells;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VoxelIndex cell = voxel_index(points[i], scale);
    for_neighbours(cell, 1, [&](VoxelKey key) {
      const auto found = cells.find(key);
      if (found == cells.end()) return;
      for (const int j : found->second) {
        const auto other = static_cast<std::size_t>(j);
        const double reach = gap + growth * std::min(ranges[i], ranges[other]);
        if ((points[i] - points[other]).squaredNorm() <= reach * reach) {
          sets.join(static_cast<int>(i), j);
        }
      }
    });
    cells[voxel_key(cell)].push_back(static_cast<int>(i));
  }
  return sets.numbers();
}

std::vector<int> voxel_components(const std::vector<VoxelKey>& voxels, int gap) {
  DisjointSets sets(voxels.size());
  VoxelMap<int> seen;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    for_neighbours(voxel_index(voxels[i]), gap, [&](VoxelKey key) {
      const auto found = seen.find(key);
      if (found != seen.end()) sets.join(static_cast<int>(i), found->second);
    });
    seen.emplace(voxels[i], static_cast<int>(i));
  }
  return sets.numbers();
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

}  // namespace raymoval
