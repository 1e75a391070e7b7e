// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/voxel_key.h"

namespace raymoval {
namespace {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t root(std::uint32_t element) {
    while (parent_[element] != element) {
      parent_[element] = parent_[parent_[element]];
      element = parent_[element];
    }
    return element;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[std::max(a, b)] = std::min(a, b); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Points of one cell; `first` and `last` index the points in order of cells.
struct Cell {
  VoxelIndex index;
  std::uint32_t first, last;
  Eigen::Array3f low, high;
  float nearest;
};

/// Columns of cells beside and before a cell's own, nearest first, so that each pair is met once.
struct ColumnOffset {
  int x, y;
  int squared_gap;  ///< Of two cells whose columns lie so apart, in cell edges.
};

std::vector<ColumnOffset> half_neighbourhood(int reach) {
  const auto gap = [](int cells) { return std::max(std::abs(cells) - 1, 0); };
  std::vector<ColumnOffset> offsets;
  for (int y = 0; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      if (y > 0 || x >= 0) offsets.push_back({x, y, gap(x) * gap(x) + gap(y) * gap(y)});
    }
  }
  std::stable_sort(
      offsets.begin(), offsets.end(),
      [](const ColumnOffset& a, const ColumnOffset& b) { return a.squared_gap < b.squared_gap; });
  return offsets;
}

class Clustering {
 public:
  Clustering(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& ranges,
             float gap, float growth)
      : points_(points), ranges_(ranges), gap_(gap), growth_(growth), edge_(gap / std::sqrt(3.0F)) {
    sort_into_cells();
  }

  std::vector<int> run() {
    DisjointSets sets(cells_.size());
    const float farthest = *std::max_element(ranges_.begin(), ranges_.end());
    const auto offsets = half_neighbourhood(
        static_cast<int>(std::ceil((gap_ + growth_ * farthest) * (1.0F + growth_) / edge_)) + 1);
    for (std::uint32_t a = 0; a < cells_.size(); ++a) {
      // The reach is that of the nearer point of a pair, so at most this cell's own.
      const float reach = (gap_ + growth_ * (cells_[a].nearest + 2.0F * edge_)) / edge_;
      for (const ColumnOffset& offset : offsets) {
        if (static_cast<float>(offset.squared_gap) > reach * reach) break;
        join_with_column(a, offset, static_cast<int>(reach) + 1, sets);
      }
    }
    return numbered(sets);
  }

 private:
  void sort_into_cells() {
    const double scale = 1.0 / edge_;
    std::vector<VoxelKey> keys(points_.size());
    order_.resize(points_.size());
    std::iota(order_.begin(), order_.end(), 0U);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const VoxelIndex cell = voxel_index(points_[i].cast<double>(), scale);
      keys[i] = voxel_key(cell.z(), cell.x(), cell.y());  // Sorted keys run up a column.
    }
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
    });
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
      const std::uint32_t point = order_[i];
      if (i == 0 || keys[point] != keys[order_[i - 1]]) {
        const VoxelIndex turned = voxel_index(keys[point]);
        const VoxelIndex index(turned.y(), turned.z(), turned.x());
        const auto number = static_cast<std::uint32_t>(cells_.size());
        const auto column =
            columns_.emplace(voxel_key(index.x(), index.y(), 0), std::pair{number, number});
        column.first.value().second = number + 1;
        cells_.push_back(
            {index, i, i, points_[point].array(), points_[point].array(), ranges_[point]});
      }
      Cell& cell = cells_.back();
      cell.last = i + 1;
      cell.low = cell.low.min(points_[point].array());
      cell.high = cell.high.max(points_[point].array());
      cell.nearest = std::min(cell.nearest, ranges_[point]);
    }
  }

  void join_with_column(std::uint32_t a, const ColumnOffset& offset, int reach,
                        DisjointSets& sets) const {
    const VoxelIndex& at = cells_[a].index;
    const auto column = columns_.find(voxel_key(at.x() + offset.x, at.y() + offset.y, 0));
    if (column == columns_.end()) return;
    const bool own = offset.x == 0 && offset.y == 0;
    const auto [first, last] = column->second;
    for (std::uint32_t b = own ? a + 1 : first; b < last; ++b) {
      const int above = cells_[b].index.z() - at.z();
      if (above < -reach) continue;
      if (above > reach) break;
      const std::uint32_t root_a = sets.root(a), root_b = sets.root(b);
      if (root_a != root_b && touch(cells_[a], cells_[b])) sets.join(root_a, root_b);
    }
  }

  [[nodiscard]] bool touch(const Cell& a, const Cell& b) const {
    const float widest = gap_ + growth_ * (std::min(a.nearest, b.nearest) + edge_ * 2.0F);
    const Eigen::Array3f apart = (a.low - b.high).max(b.low - a.high).max(0.0F);
    if (apart.square().sum() > widest * widest) return false;
    for (std::uint32_t i = a.first; i < a.last; ++i) {
      const std::uint32_t p = order_[i];
      for (std::uint32_t j = b.first; j < b.last; ++j) {
        const std::uint32_t q = order_[j];
        const float reach = gap_ + growth_ * std::min(ranges_[p], ranges_[q]);
        if ((points_[p] - points_[q]).squaredNorm() <= reach * reach) return true;
      }
    }
    return false;
  }

  std::vector<int> numbered(DisjointSets& sets) {
    std::vector<std::uint32_t> root(points_.size());
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
      const std::uint32_t of_cell = sets.root(c);
      for (std::uint32_t i = cells_[c].first; i < cells_[c].last; ++i) root[order_[i]] = of_cell;
    }
    std::vector<int> number_of(cells_.size(), -1), numbers(points_.size());
    int next = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      int& number = number_of[root[i]];
      if (number < 0) number = next++;
      numbers[i] = number;
    }
    return numbers;
  }

  const std::vector<Eigen::Vector3f>& points_;
  const std::vector<float>& ranges_;
  float gap_, growth_, edge_;
  std::vector<std::uint32_t> order_;
  std::vector<Cell> cells_;
  VoxelMap<std::pair<std::uint32_t, std::uint32_t>> columns_;  ///< Cells of each column.
};

}  // namespace

std::vector<int> euclidean_clusters(const std::vector<Eigen::Vector3f>& points,
                                    const std::vector<float>& ranges, float gap, float growth) {
  if (points.empty()) return {};
  return Clustering(points, ranges, gap, growth).run();
}

}  // namespace raymoval
