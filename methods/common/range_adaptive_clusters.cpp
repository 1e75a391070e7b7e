// SPDX-License-Identifier: MIT
#include "methods/common/range_adaptive_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/scan/voxel_key.h"
#include "methods/common/disjoint_sets.h"

namespace raymoval {
namespace {

/// Points of one cell; `first` and `last` index the points in order of cells.
template <class Scalar>
struct Cell {
  int z;
  std::uint32_t first, last;
  Eigen::Array<Scalar, 3, 1> low, high;
  Scalar farthest;  ///< Largest range of its points.
};

/// The cells above each other.
template <class Scalar>
struct Column {
  int x, y;
  std::uint32_t first, last;
  Scalar reach;              ///< The longest reach of its cells, in cell edges.
  std::uint32_t root;        ///< The root that all of its cells have, or `kMixed`.
  std::uint32_t same_until;  ///< Up to before this column, those of the row have the same root.
};
constexpr std::uint32_t kMixed = 0xFFFFFFFFU;

/// Cells whose diagonal is the smallest reach save nearly all comparisons: the points of one cell
/// are joined, and two cells are joined by the first pair of points that is near enough.
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
        // Made smaller by a rounding error, where the precision has room for it.
        edge_(gap / std::sqrt(Scalar(3)) * static_cast<Scalar>(1.0 - 1e-9)) {
    sort_into_cells();
  }

  std::vector<int> run() {
    DisjointSets sets(cells_.size());
    // Cells beside each other first: what hangs together mostly does so by them, and whole columns
    // of one set need no second look.
    join_all(Pass::kBeside, sets);
    store_roots(sets);
    join_all(Pass::kInReach, sets);
    return numbered(sets);
  }

 private:
  [[nodiscard]] Scalar reach_at(Scalar range) const { return gap_ + growth_ * range; }
  /// The reach in cell edges, and a little more, since cells are found with other roundings than
  /// distances.
  [[nodiscard]] Scalar reach_in_cells(Scalar range) const {
    return reach_at(range) / edge_ * static_cast<Scalar>(1.0 + 1e-4);
  }

  /// Makes cells, columns and rows, in order of y, x and z.
  void sort_into_cells() {
    std::vector<Run> runs = runs_in_cells();
    const VoxelKey corner = low_corner(runs);
    for (Run& run : runs) run.key -= corner;  // Keys then differ in few digits.
    sort_by_key(runs);
    order_.reserve(points_.size());
    placed_.reserve(points_.size());
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const Run& run = runs[r];
      if (r == 0 || run.key != runs[r - 1].key) begin_cell(run.key + corner, run.first);
      for (std::uint32_t point = run.first; point < run.last; ++point) {
        add_to_cell(point, cells_.back());
      }
    }
    for (Column<Scalar>& column : columns_) {
      for (std::uint32_t c = column.first; c < column.last; ++c) {
        column.reach = std::max(column.reach, reach_in_cells(cells_[c].farthest));
      }
    }
    rows_.push_back(static_cast<std::uint32_t>(columns_.size()));
  }

  /// The points from `first` to before `last` follow each other and lie in the same cell.
  struct Run {
    VoxelKey key;
    std::uint32_t first, last;
  };

  /// The runs of all points in their order. Keys that are sorted run up a column.
  std::vector<Run> runs_in_cells() const {
    const double scale = 1.0 / edge_;
    std::vector<Run> runs;
    runs.reserve(points_.size() / 2);
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const VoxelIndex cell = cell_at(points_[i].template cast<double>() * scale);
      const VoxelKey key = voxel_key(cell.z(), cell.x(), cell.y());
      if (runs.empty() || runs.back().key != key) runs.push_back({key, i, i});
      runs.back().last = i + 1;
    }
    return runs;
  }

  /// The least of each of the three numbers in the keys of runs, as a key.
  static VoxelKey low_corner(const std::vector<Run>& runs) {
    constexpr VoxelKey kField = (VoxelKey{1} << kVoxelBits) - 1;
    VoxelKey corner = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const VoxelKey field = kField << (axis * kVoxelBits);
      VoxelKey least = field;
      for (const Run& run : runs) least = std::min(least, run.key & field);
      corner |= least;
    }
    return corner;
  }

  /// `voxel_index` without a call of a library for each coordinate.
  static VoxelIndex cell_at(const Eigen::Vector3d& in_cells) {
    if (!(in_cells.cwiseAbs().maxCoeff() < kVoxelLimit)) return voxel_index(in_cells, 1.0);
    const auto floor_of = [](double value) {
      const int whole = static_cast<int>(value);
      return whole - (value < whole ? 1 : 0);
    };
    return {floor_of(in_cells.x()), floor_of(in_cells.y()), floor_of(in_cells.z())};
  }

  /// Sorts runs by their keys, and those of a key by their points: digit by digit from the lowest,
  /// of which only those are looked at in which keys differ.
  static void sort_by_key(std::vector<Run>& runs) {
    constexpr int kDigitBits = 8;
    constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
    VoxelKey differing = 0;
    for (const Run& run : runs) differing |= run.key ^ runs.front().key;
    std::vector<Run> sorted(runs.size());
    for (int shift = 0; shift < 64; shift += kDigitBits) {
      const auto digit_of = [&](VoxelKey key) { return key >> shift & (kDigits - 1); };
      if (digit_of(differing) == 0) continue;
      std::array<std::uint32_t, kDigits + 1> next{};
      for (const Run& run : runs) ++next[digit_of(run.key) + 1];
      std::partial_sum(next.begin(), next.end(), next.begin());
      for (const Run& run : runs) sorted[next[digit_of(run.key)]++] = run;
      runs.swap(sorted);
    }
  }

  void begin_cell(VoxelKey key, std::uint32_t point) {
    const VoxelIndex turned = voxel_index(key);
    const int x = turned.y(), y = turned.z();
    const auto number = static_cast<std::uint32_t>(cells_.size());
    const bool new_row = columns_.empty() || columns_.back().y != y;
    if (new_row) rows_.push_back(static_cast<std::uint32_t>(columns_.size()));
    if (new_row || columns_.back().x != x)
      columns_.push_back({x, y, number, number, Scalar(0), kMixed, 0});
    columns_.back().last = number + 1;
    const auto first = static_cast<std::uint32_t>(order_.size());
    cells_.push_back(
        {turned.x(), first, first, points_[point].array(), points_[point].array(), ranges_[point]});
  }

  void add_to_cell(std::uint32_t point, Cell<Scalar>& cell) {
    order_.push_back(point);
    placed_.push_back({points_[point], ranges_[point]});
    ++cell.last;
    cell.low = cell.low.min(points_[point].array());
    cell.high = cell.high.max(points_[point].array());
    cell.farthest = std::max(cell.farthest, ranges_[point]);
  }

  enum class Pass { kBeside, kInReach };

  void join_all(Pass pass, DisjointSets& sets) const {
    const Scalar widest =
        std::max_element(columns_.begin(), columns_.end(), [](const auto& a, const auto& b) {
          return a.reach < b.reach;
        })->reach;
    const Scalar apart = pass == Pass::kBeside ? Scalar(0) : widest;
    for (std::size_t row = 0; row + 1 < rows_.size(); ++row) {
      const int y = columns_[rows_[row]].y;
      for (std::size_t other = row; other + 1 < rows_.size(); ++other) {
        if (static_cast<Scalar>(columns_[rows_[other]].y - y - 1) > apart) break;
        join_rows(row, other, pass, sets);
      }
    }
  }

  void store_roots(DisjointSets& sets) {
    for (Column<Scalar>& column : columns_) {
      column.root = sets.root(column.first);
      for (std::uint32_t c = column.first; c < column.last; ++c) {
        if (sets.root(c) != column.root) column.root = kMixed;
      }
    }
    for (std::size_t c = columns_.size(); c-- > 0;) {
      const bool goes_on = c + 1 < columns_.size() && columns_[c + 1].y == columns_[c].y &&
                           columns_[c + 1].root == columns_[c].root;
      columns_[c].same_until =
          goes_on ? columns_[c + 1].same_until : static_cast<std::uint32_t>(c + 1);
    }
  }

  /// Joins every pair of columns of two rows once.
  void join_rows(std::size_t row, std::size_t other, Pass pass, DisjointSets& sets) const {
    const std::uint32_t end = rows_[other + 1];
    std::uint32_t begin = rows_[other];  // The first column that is not too far to the left.
    for (std::uint32_t c = rows_[row]; c < rows_[row + 1]; ++c) {
      const Column<Scalar>& column = columns_[c];
      // The reach is that of the nearer point of a pair, so at most this column's own.
      const auto gap = [](int cells) { return static_cast<Scalar>(std::max(cells - 1, 0)); };
      const Scalar across = gap(columns_[rows_[other]].y - column.y);
      const Scalar left = column.reach * column.reach - across * across;
      if (left < 0) continue;
      const int aside = pass == Pass::kBeside ? 1 : static_cast<int>(std::sqrt(left)) + 2;
      begin = first_from(begin, end, column.x - aside);
      for (std::uint32_t n = other == row ? c : begin; n < end; ++n) {
        const Column<Scalar>& near = columns_[n];
        if (near.x > column.x + aside) break;
        if (pass == Pass::kInReach && column.root == near.root && column.root != kMixed) {
          n = near.same_until - 1;
          continue;
        }
        const Scalar along = gap(std::abs(near.x - column.x));
        const int reach = pass == Pass::kBeside ? 1 : static_cast<int>(column.reach) + 1;
        if (along * along <= left) join_columns(column, near, reach, sets);
      }
    }
  }

  /// The first column of a row at `x` or to the right of it. It is looked for on both sides of
  /// `guess`, from which it is never far.
  [[nodiscard]] std::uint32_t first_from(std::uint32_t guess, std::uint32_t end, int x) const {
    while (guess < end && columns_[guess].x < x) ++guess;
    while (guess > 0 && columns_[guess - 1].y == columns_[end - 1].y &&
           columns_[guess - 1].x >= x) {
      --guess;
    }
    return guess;
  }

  /// Joins cells at most `reach` cells above or below each other.
  void join_columns(const Column<Scalar>& one, const Column<Scalar>& other, int reach,
                    DisjointSets& sets) const {
    std::uint32_t lowest = other.first;
    for (std::uint32_t a = one.first; a < one.last; ++a) {
      while (lowest < other.last && cells_[lowest].z < cells_[a].z - reach) ++lowest;
      std::uint32_t root = sets.root(a);
      for (std::uint32_t b = &one == &other ? a + 1 : lowest; b < other.last; ++b) {
        if (cells_[b].z > cells_[a].z + reach) break;
        const std::uint32_t other_root = sets.root(b);
        if (root == other_root || !touch(cells_[a], cells_[b])) continue;
        sets.join(root, other_root);
        root = std::min(root, other_root);
      }
    }
  }

  [[nodiscard]] bool touch(const Cell<Scalar>& a, const Cell<Scalar>& b) const {
    const Scalar widest = reach_at(std::min(a.farthest, b.farthest));
    const Array apart = (a.low - b.high).max(b.low - a.high).max(Scalar(0));
    if (apart.matrix().squaredNorm() > widest * widest) return false;
    for (std::uint32_t i = a.first; i < a.last; ++i) {
      const Placed& p = placed_[i];
      for (std::uint32_t j = b.first; j < b.last; ++j) {
        const Placed& q = placed_[j];
        const Scalar near_enough = reach_at(std::min(p.range, q.range));
        if ((p.point - q.point).squaredNorm() <= near_enough * near_enough) return true;
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
  /// A point and its range.
  struct Placed {
    Vector point;
    Scalar range;
  };
  std::vector<std::uint32_t> order_;  ///< The points in order of cells, ...
  std::vector<Placed> placed_;        ///< ... and what they are.
  std::vector<Cell<Scalar>> cells_;
  std::vector<Column<Scalar>> columns_;
  std::vector<std::uint32_t> rows_;  ///< First column of each row, and the end.
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
