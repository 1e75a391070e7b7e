// SPDX-License-Identifier: MIT
#include "methods/range_adaptive_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/voxel_key.h"
#include "methods/disjoint_sets.h"

namespace raymoval {
namespace {

/// Points of one cell; `first` and `last` index the points in order of cells.
template <class Scalar>
struct Cell {
  VoxelIndex index;
  std::uint32_t first, last;
  Eigen::Array<Scalar, 3, 1> low, high;
  Scalar farthest;  ///< Largest range of its points.
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

/// Cells whose diagonal is the smallest reach save nearly all comparisons: what is in one is
/// joined, and of two cells only the first pair near enough has to be found.
template <class Scalar>
class Clustering {
  using Vector = Eigen::Matrix<Scalar, 3, 1>;
  using Array = Eigen::Array<Scalar, 3, 1>;

 public:
  Clustering(const std::vector<Vector>& points, const std::vector<Scalar>& ranges, Scalar gap,
             Scalar growth)
      : points_(points),
        ranges_(ranges),
        gap_(gap),
        growth_(growth),
        // A rounding less, where the precision has room for it.
        edge_(gap / std::sqrt(Scalar(3)) * static_cast<Scalar>(1.0 - 1e-9)) {
    sort_into_cells();
  }

  std::vector<int> run() {
    DisjointSets sets(cells_.size());
    const Scalar farthest = *std::max_element(ranges_.begin(), ranges_.end());
    const double reach = std::ceil(reach_in_cells(farthest)) + 1.0;
    const double columns_in_reach = 2.0 * reach * reach;
    if (columns_in_reach > static_cast<double>(cells_.size())) {
      join_all_pairs(sets);
    } else {
      join_neighbours(half_neighbourhood(static_cast<int>(reach)), sets);
    }
    return numbered(sets);
  }

 private:
  [[nodiscard]] Scalar reach_at(Scalar range) const { return gap_ + growth_ * range; }
  /// In cell edges, and a little more: cells are found in other roundings than distances.
  [[nodiscard]] Scalar reach_in_cells(Scalar range) const {
    return reach_at(range) / edge_ * static_cast<Scalar>(1.0 + 1e-4);
  }

  void join_all_pairs(DisjointSets& sets) const {
    for (std::uint32_t a = 1; a < cells_.size(); ++a) {
      for (std::uint32_t b = 0; b < a; ++b) join_if_near(a, b, sets);
    }
  }

  void join_neighbours(const std::vector<ColumnOffset>& offsets, DisjointSets& sets) const {
    for (std::uint32_t a = 0; a < cells_.size(); ++a) {
      // The reach is that of the nearer point of a pair, so at most this cell's own.
      const Scalar reach = reach_in_cells(cells_[a].farthest);
      for (const ColumnOffset& offset : offsets) {
        if (static_cast<Scalar>(offset.squared_gap) > reach * reach) break;
        join_with_column(a, offset, static_cast<int>(reach) + 1, sets);
      }
    }
  }

  void sort_into_cells() {
    const double scale = 1.0 / edge_;
    std::vector<VoxelKey> keys(points_.size());
    order_.resize(points_.size());
    std::iota(order_.begin(), order_.end(), 0U);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const VoxelIndex cell = voxel_index(points_[i].template cast<double>(), scale);
      keys[i] = voxel_key(cell.z(), cell.x(), cell.y());  // Sorted keys run up a column.
    }
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
    });
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
      const std::uint32_t point = order_[i];
      if (i == 0 || keys[point] != keys[order_[i - 1]]) begin_cell(keys[point], i);
      add_to_cell(point, cells_.back());
    }
  }

  void begin_cell(VoxelKey key, std::uint32_t first) {
    const VoxelIndex turned = voxel_index(key);
    const VoxelIndex index(turned.y(), turned.z(), turned.x());
    const auto number = static_cast<std::uint32_t>(cells_.size());
    const auto column =
        columns_.emplace(voxel_key(index.x(), index.y(), 0), std::pair{number, number});
    column.first.value().second = number + 1;
    const std::uint32_t point = order_[first];
    cells_.push_back(
        {index, first, first, points_[point].array(), points_[point].array(), ranges_[point]});
  }

  void add_to_cell(std::uint32_t point, Cell<Scalar>& cell) const {
    ++cell.last;
    cell.low = cell.low.min(points_[point].array());
    cell.high = cell.high.max(points_[point].array());
    cell.farthest = std::max(cell.farthest, ranges_[point]);
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
      join_if_near(a, b, sets);
    }
  }

  void join_if_near(std::uint32_t a, std::uint32_t b, DisjointSets& sets) const {
    const std::uint32_t root_a = sets.root(a), root_b = sets.root(b);
    if (root_a != root_b && touch(cells_[a], cells_[b])) sets.join(root_a, root_b);
  }

  [[nodiscard]] bool touch(const Cell<Scalar>& a, const Cell<Scalar>& b) const {
    const Scalar widest = reach_at(std::min(a.farthest, b.farthest));
    const Array apart = (a.low - b.high).max(b.low - a.high).max(Scalar(0));
    if (apart.matrix().squaredNorm() > widest * widest) return false;
    for (std::uint32_t i = a.first; i < a.last; ++i) {
      const std::uint32_t p = order_[i];
      for (std::uint32_t j = b.first; j < b.last; ++j) {
        const std::uint32_t q = order_[j];
        const Scalar near_enough = reach_at(std::min(ranges_[p], ranges_[q]));
        if ((points_[p] - points_[q]).squaredNorm() <= near_enough * near_enough) return true;
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

  const std::vector<Vector>& points_;
  const std::vector<Scalar>& ranges_;
  Scalar gap_, growth_, edge_;
  std::vector<std::uint32_t> order_;
  std::vector<Cell<Scalar>> cells_;
  VoxelMap<std::pair<std::uint32_t, std::uint32_t>> columns_;  ///< Cells of each column.
};

}  // namespace

std::vector<int> range_adaptive_clusters(const std::vector<Eigen::Vector3d>& points,
                                         const std::vector<double>& ranges, double gap,
                                         double growth) {
  if (points.empty()) return {};
  return Clustering<double>(points, ranges, gap, growth).run();
}

std::vector<int> range_adaptive_clusters(const std::vector<Eigen::Vector3f>& points,
                                         const std::vector<float>& ranges, float gap,
                                         float growth) {
  if (points.empty()) return {};
  return Clustering<float>(points, ranges, gap, growth).run();
}

}  // namespace raymoval
