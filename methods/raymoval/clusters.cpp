// SPDX-License-Identifier: MIT
#include "methods/raymoval/clusters.h"

#include <algorithm>
#include <cmath>
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

namespace {

/// Points that are so near to each other that they are joined whatever their ranges.
struct Clump {
  VoxelIndex cell;
  int first = -1;         ///< Its points are a chain, see `next_`.
  double farthest = 0.0;  ///< Largest range of its points, metres.
};

/// Joins points as `range_adaptive_clusters` says. Clumps save nearly all comparisons: what is in
/// one is joined, and of two clumps only the first pair near enough has to be found.
class Clustering {
 public:
  Clustering(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& ranges,
             double gap, double growth)
      : points_(points), ranges_(ranges), gap_(gap), growth_(growth), sets_(points.size()) {
    // The diagonal of a clump is as long as the smallest reach, a rounding less.
    side_ = gap / std::numbers::sqrt3 * (1.0 - 1e-9);
    collect_clumps();
    collect_blocks();
  }

  std::vector<int> run() {
    for (const Block& block : blocks_) {
      for (std::size_t i = 1; i < block.clumps.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) join(block.clumps[i], block.clumps[j]);
      }
      join_with_neighbours(block);
    }
    return sets_.numbers();
  }

 private:
  /// Clumps within a cube as wide as the widest reach: partners are in the same or the next one.
  struct Block {
    VoxelIndex at;
    std::vector<int> clumps;
  };

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  static int floor_divide(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }
  [[nodiscard]] double reach(double range) const { return gap_ + growth_ * range; }

  void collect_clumps() {
    VoxelMap<int> numbers;
    next_.assign(points_.size(), -1);
    const double scale = 1.0 / side_;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const VoxelIndex cell = voxel_index(points_[i], scale);
      const auto [found, is_new] =
          numbers.try_emplace(voxel_key(cell), static_cast<int>(clumps_.size()));
      if (is_new) clumps_.push_back({cell, -1, 0.0});
      Clump& clump = clumps_[index(found->second)];
      if (clump.first >= 0) sets_.join(clump.first, static_cast<int>(i));
      next_[i] = clump.first;
      clump.first = static_cast<int>(i);
      clump.farthest = std::max(clump.farthest, ranges_[i]);
    }
  }

  void collect_blocks() {
    const double widest = reach(*std::max_element(ranges_.begin(), ranges_.end()));
    const int side = static_cast<int>(std::ceil(widest / side_)) + 1;
    for (std::size_t c = 0; c < clumps_.size(); ++c) {
      const VoxelIndex& cell = clumps_[c].cell;
      const VoxelIndex at(floor_divide(cell.x(), side), floor_divide(cell.y(), side),
                          floor_divide(cell.z(), side));
      const auto [found, is_new] =
          block_numbers_.try_emplace(voxel_key(at), static_cast<int>(blocks_.size()));
      if (is_new) blocks_.push_back({at, {}});
      blocks_[index(found->second)].clumps.push_back(static_cast<int>(c));
    }
  }

  void join_with_neighbours(const Block& block) {
    const VoxelKey own = voxel_key(block.at);
    for_neighbours(block.at, 1, [&](VoxelKey key) {
      if (key <= own) return;  // Every pair once.
      const auto found = block_numbers_.find(key);
      if (found == block_numbers_.end()) return;
      for (const int a : block.clumps) {
        for (const int b : blocks_[index(found->second)].clumps) join(a, b);
      }
    });
  }

  /// Joins two clumps if any pair of their points is near enough.
  void join(int one, int other) {
    const Clump& a = clumps_[index(one)];
    const Clump& b = clumps_[index(other)];
    const double longest = reach(std::min(a.farthest, b.farthest));
    const Eigen::Vector3i cells = ((a.cell - b.cell).cwiseAbs().array() - 1).max(0).matrix();
    if (cells.squaredNorm() * side_ * side_ > longest * longest * (1.0 + 1e-9)) return;
    if (sets_.root(a.first) == sets_.root(b.first)) return;
    for (int i = a.first; i >= 0; i = next_[index(i)]) {
      for (int j = b.first; j >= 0; j = next_[index(j)]) {
        const double near_enough = reach(std::min(ranges_[index(i)], ranges_[index(j)]));
        if ((points_[index(i)] - points_[index(j)]).squaredNorm() <= near_enough * near_enough) {
          sets_.join(i, j);
          return;
        }
      }
    }
  }

  const std::vector<Eigen::Vector3d>& points_;
  const std::vector<double>& ranges_;
  double gap_, growth_, side_;
  DisjointSets sets_;
  std::vector<Clump> clumps_;
  std::vector<int> next_;
  std::vector<Block> blocks_;
  VoxelMap<int> block_numbers_;
};

}  // namespace

std::vector<int> range_adaptive_clusters(const std::vector<Eigen::Vector3d>& points,
                                         const std::vector<double>& ranges, double gap,
                                         double growth) {
  if (points.empty()) return {};
  return Clustering(points, ranges, gap, growth).run();
}

std::vector<int> voxel_components(const std::vector<VoxelKey>& voxels, int gap) {
  DisjointSets sets(voxels.size());
  VoxelMap<int> seen;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const auto [first, is_new] = seen.emplace(voxels[i], static_cast<int>(i));
    if (!is_new) sets.join(static_cast<int>(i), first->second);
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
  const int last =
      cluster_of.empty() ? -1 : *std::max_element(cluster_of.begin(), cluster_of.end());
  std::vector<int> first_component(static_cast<std::size_t>(last + 1), -1);
  for (std::size_t i = 0; i < cluster_of.size(); ++i) {
    int& first = first_component[static_cast<std::size_t>(cluster_of[i])];
    if (first < 0) first = component_of[i];
    components.join(first, component_of[i]);
  }
  std::vector<int> group(component_of.size());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = components.root(component_of[i]);
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

}  // namespace raymoval
