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
  std::vector<int> points;
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
  }

  std::vector<int> run() {
    const double widest = reach(*std::max_element(ranges_.begin(), ranges_.end()));
    // Blocks of clumps as wide as the widest reach: partners are in the same or the next one.
    const int block = static_cast<int>(std::ceil(widest / side_)) + 1;
    VoxelMap<std::vector<int>> blocks;
    for (std::size_t c = 0; c < clumps_.size(); ++c) {
      const VoxelIndex& cell = clumps_[c].cell;
      const VoxelIndex at(floor_divide(cell.x(), block), floor_divide(cell.y(), block),
                          floor_divide(cell.z(), block));
      for_neighbours(at, 1, [&](VoxelKey key) {
        const auto found = blocks.find(key);
        if (found == blocks.end()) return;
        for (const int other : found->second) join(clumps_[c], clumps_[index(other)]);
      });
      blocks[voxel_key(at)].push_back(static_cast<int>(c));
    }
    return sets_.numbers();
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  static int floor_divide(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }
  [[nodiscard]] double reach(double range) const { return gap_ + growth_ * range; }

  void collect_clumps() {
    VoxelMap<int> numbers;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const VoxelIndex cell = voxel_index(points_[i], 1.0 / side_);
      const auto [found, is_new] =
          numbers.try_emplace(voxel_key(cell), static_cast<int>(clumps_.size()));
      if (is_new) clumps_.push_back({cell, {}, 0.0});
      Clump& clump = clumps_[index(found->second)];
      if (!clump.points.empty()) sets_.join(clump.points.front(), static_cast<int>(i));
      clump.points.push_back(static_cast<int>(i));
      clump.farthest = std::max(clump.farthest, ranges_[i]);
    }
  }

  /// Joins two clumps if any pair of their points is near enough.
  void join(const Clump& a, const Clump& b) {
    const double longest = reach(std::min(a.farthest, b.farthest));
    const Eigen::Vector3i cells = ((a.cell - b.cell).cwiseAbs().array() - 1).max(0).matrix();
    if (cells.squaredNorm() * side_ * side_ > longest * longest * (1.0 + 1e-9)) return;
    if (sets_.root(a.points.front()) == sets_.root(b.points.front())) return;
    for (const int i : a.points) {
      for (const int j : b.points) {
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
    if (!is_new) {
      sets.join(static_cast<int>(i), first->second);
      continue;
    }
    for_neighbours(voxel_index(voxels[i]), gap, [&](VoxelKey key) {
      const auto found = seen.find(key);
      if (found != seen.end()) sets.join(static_cast<int>(i), found->second);
    });
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
