// SPDX-License-Identifier: MIT
#include "methods/common/range_adaptive_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/floor.h"
#include "core/scan/voxel_key.h"
#include "methods/common/disjoint_sets.h"

namespace raymoval {
namespace {

/// The least and the largest coordinates of some points, and of their ranges in the last place.
template <class Scalar>
struct Box {
  using Array = Eigen::Array<Scalar, 4, 1>;
  Array low = Array::Constant(std::numeric_limits<Scalar>::infinity());
  Array high = -low;

  void add(const Array& point) {
    low = low.min(point);
    high = high.max(point);
  }
  void add(const Box& other) {
    low = low.min(other.low);
    high = high.max(other.high);
  }
  [[nodiscard]] Scalar farthest() const { return high[3]; }
  /// The distance of the boxes along each axis.
  [[nodiscard]] Eigen::Matrix<Scalar, 3, 1> apart(const Box& other) const {
    const Array gaps = (low - other.high).max(other.low - high).max(Scalar(0));
    return gaps.matrix().template head<3>();
  }
};

/// The points from `first` to before `last` are consecutive and in the same cell.
struct Run {
  VoxelKey key;
  std::uint32_t first, last;
};

/// `first` and `last` number the runs of its points.
template <class Scalar>
struct Cell {
  int z;
  std::uint32_t first, last;
  Box<Scalar> box;
};

/// Cells directly above each other, each touching the next: one cluster.
template <class Scalar>
struct Piece {
  int y;                      ///< Its row.
  std::uint32_t first, last;  ///< Its cells.
  Box<Scalar> box;
  Scalar reach = 0;  ///< The longest reach of its points, in cell edges.
};

/// The position of a piece in its row, and the root of its set at the last look-up.
struct Place {
  int x, low, high;  ///< Its column, and z of its lowest and its highest cell.
  std::uint32_t root;
};

/// The minimum of each of the three numbers in the keys of runs, as a key.
VoxelKey low_corner(const std::vector<Run>& runs) {
  constexpr VoxelKey kField = (VoxelKey{1} << kVoxelBits) - 1;
  std::array<VoxelKey, 3> least{kField, kField << kVoxelBits, kField << (2 * kVoxelBits)};
  const std::array<VoxelKey, 3> fields = least;
  for (const Run& run : runs) {
    for (std::size_t axis = 0; axis < least.size(); ++axis) {
      least[axis] = std::min(least[axis], run.key & fields[axis]);
    }
  }
  return least[0] | least[1] | least[2];
}

/// Sorts runs by their keys, and those of a key by their points: digit by digit from the lowest,
/// skipping digits that are equal in all keys. Each number of a key has two digits.
void sort_by_key(std::vector<Run>& runs) {
  constexpr int kDigitBits = 11;
  constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
  static_assert(2 * kDigitBits > kVoxelBits);
  VoxelKey differing = 0;
  for (const Run& run : runs) differing |= run.key ^ runs.front().key;
  std::vector<Run> sorted(runs.size());
  for (const int shift : {0, kDigitBits, kVoxelBits, kVoxelBits + kDigitBits, 2 * kVoxelBits,
                          2 * kVoxelBits + kDigitBits}) {
    const auto digit_of = [&](VoxelKey key) { return key >> shift & (kDigits - 1); };
    if (digit_of(differing) == 0) continue;
    std::array<std::uint32_t, kDigits + 1> next{};
    for (const Run& run : runs) ++next[digit_of(run.key) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (const Run& run : runs) sorted[next[digit_of(run.key)]++] = run;
    runs.swap(sorted);
  }
}

/// `voxel_index` without a library call for each coordinate.
VoxelIndex cell_at(const Eigen::Vector3d& in_cells) {
  if (!(in_cells.cwiseAbs().maxCoeff() < kVoxelLimit)) return voxel_index(in_cells, 1.0);
  return {floor_of(in_cells.x()), floor_of(in_cells.y()), floor_of(in_cells.z())};
}

/// Cells whose diagonal is the smallest reach avoid nearly all comparisons: the points of one cell
/// are joined, and two cells are joined by the first pair of points that is near enough.
template <class Scalar>
class Clustering {
  using Vector = Eigen::Matrix<Scalar, 3, 1>;

 public:
  Clustering(const std::vector<Vector>& points, const std::vector<Scalar>& ranges, Scalar gap,
             Scalar growth)
      : points_(points),
        ranges_(ranges),
        gap_(gap),
        growth_(growth),
        // Smaller by a rounding error, if the precision allows it.
        edge_(gap / std::sqrt(Scalar(3)) * static_cast<Scalar>(1.0 - 1e-9)) {
    sort_into_cells();
  }

  std::vector<int> run() {
    DisjointSets sets(pieces_.size());
    // Most connections are between consecutive points.
    join_along_points(sets);
    for (std::uint32_t p = 0; p < places_.size(); ++p) places_[p].root = sets.root(p);
    join_in_reach(sets);
    return numbered(sets);
  }

 private:
  [[nodiscard]] Scalar reach_at(Scalar range) const { return gap_ + growth_ * range; }
  /// The reach in cell edges, slightly enlarged, because cells and distances are rounded
  /// differently.
  [[nodiscard]] Scalar reach_in_cells(Scalar range) const {
    return reach_at(range) / edge_ * static_cast<Scalar>(1.0 + 1e-4);
  }

  /// Makes cells, pieces and rows, in order of y, x and z.
  void sort_into_cells() {
    find_runs();
    const VoxelKey corner = low_corner(runs_);
    for (Run& run : runs_) run.key -= corner;  // Keys then differ in few digits.
    sort_by_key(runs_);
    cells_.reserve(runs_.size());
    piece_of_.resize(points_.size());
    for (std::uint32_t first = 0, last = 0; first < runs_.size(); first = last) {
      Box<Scalar> box;
      for (; last < runs_.size() && runs_[last].key == runs_[first].key; ++last) {
        for (std::uint32_t i = runs_[last].first; i < runs_[last].last; ++i) {
          const Vector& point = points_[i];
          box.add({point.x(), point.y(), point.z(), ranges_[i]});
        }
      }
      const VoxelIndex turned = voxel_index(runs_[first].key + corner);
      add_cell(turned.y(), turned.z(), {turned.x(), first, last, box});
    }
    rows_.push_back(static_cast<std::uint32_t>(pieces_.size()));
    for (Piece<Scalar>& piece : pieces_) piece.reach = reach_in_cells(piece.box.farthest());
  }

  /// Finds the runs of all points in their order. Sorted keys run up a column.
  void find_runs() {
    const double scale = 1.0 / edge_;
    runs_.reserve(points_.size() / 2);
    VoxelIndex last;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const VoxelIndex cell = cell_at(points_[i].template cast<double>() * scale);
      if (i > 0 && cell == last) continue;
      if (i > 0) runs_.back().last = i;
      runs_.push_back({voxel_key(cell.z(), cell.x(), cell.y()), i, i});
      last = cell;
    }
    if (!runs_.empty()) runs_.back().last = static_cast<std::uint32_t>(points_.size());
  }

  /// Adds a cell that is above or after all others.
  void add_cell(int x, int y, const Cell<Scalar>& cell) {
    const bool new_row = pieces_.empty() || pieces_.back().y != y;
    const auto number = static_cast<std::uint32_t>(cells_.size());
    if (new_row) rows_.push_back(static_cast<std::uint32_t>(pieces_.size()));
    const bool goes_on = !new_row && places_.back().x == x && places_.back().high + 1 == cell.z &&
                         touch(cells_.back(), cell);
    if (!goes_on) {
      pieces_.push_back({y, number, number, {}});
      places_.push_back({x, cell.z, cell.z, 0});
    }
    Piece<Scalar>& piece = pieces_.back();
    places_.back().high = cell.z;
    piece.last = number + 1;
    piece.box.add(cell.box);
    cells_.push_back(cell);
    for (std::uint32_t r = cell.first; r < cell.last; ++r) {
      std::fill(piece_of_.begin() + runs_[r].first, piece_of_.begin() + runs_[r].last,
                static_cast<std::uint32_t>(pieces_.size() - 1));
    }
  }

  /// Joins the pieces of each point and the one before it, if these are near enough.
  void join_along_points(DisjointSets& sets) const {
    for (const Run& run : runs_) {
      const std::uint32_t i = run.first;
      if (i == 0) continue;
      const std::uint32_t one = sets.root(piece_of_[i]), other = sets.root(piece_of_[i - 1]);
      if (one != other && are_near(i, i - 1)) sets.join(one, other);
    }
  }

  /// Joins every pair of pieces that are near enough; visits each pair once.
  void join_in_reach(DisjointSets& sets) {
    // The first piece of each row that is not too far to the left. The pieces of the row above are
    // visited from left to right, so that it moves little.
    std::vector<std::uint32_t> begin(rows_.size());
    std::vector<std::uint32_t> others(pieces_.size());
    for (std::size_t row = 0; row + 1 < rows_.size(); ++row) {
      const int y = pieces_[rows_[row]].y;
      std::copy(rows_.begin() + static_cast<std::ptrdiff_t>(row), rows_.end(), begin.begin());
      for (std::uint32_t p = rows_[row]; p < rows_[row + 1]; ++p) {
        for (std::size_t other = row; other + 1 < rows_.size(); ++other) {
          // The reach is that of the nearer point of a pair, so at most this piece's own.
          const auto across = static_cast<Scalar>(std::max(pieces_[rows_[other]].y - y - 1, 0));
          if (across > pieces_[p].reach) break;
          join_with_row(p, other, across, begin[other - row], others.data(), sets);
        }
      }
    }
  }

  /// Joins a piece with the pieces of its own or a later row.
  void join_with_row(std::uint32_t p, std::size_t row, Scalar across, std::uint32_t& begin,
                     std::uint32_t* others, DisjointSets& sets) {
    const Scalar reach = pieces_[p].reach;
    const int aside = static_cast<int>(std::sqrt(reach * reach - across * across)) + 1;
    const int above = static_cast<int>(reach) + 1;
    begin = first_from(begin, rows_[row], rows_[row + 1], places_[p].x - aside);
    const std::uint32_t first = begin <= p ? p + 1 : begin;
    const std::size_t count = find_others(places_[p], aside, above, first, rows_[row + 1], others);
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t one = sets.root(p), another = sets.root(others[i]);
      if (one != another && touch(p, others[i], above)) {
        sets.join(one, another);
        one = another = std::min(one, another);
      }
      places_[p].root = one;
      places_[others[i]].root = another;
    }
  }

  /// Finds the pieces of a row from number `n` on that lie at most `aside` cells beside `place` and
  /// `above` cells above or below it, and have another root. Most have the same root, and are left
  /// out without a branch for each. @return their number; the pieces are in `others`
  std::size_t find_others(const Place& place, int aside, int above, std::uint32_t n,
                          std::uint32_t end, std::uint32_t* others) const {
    const Place* const places = places_.data();
    const int farthest = place.x + aside, low = place.low - above, high = place.high + above;
    const std::uint32_t root = place.root;
    std::size_t count = 0;
    for (; n < end && places[n].x <= farthest; ++n) {
      others[count] = n;
      count += static_cast<std::size_t>(int{places[n].root != root} & int{places[n].low <= high} &
                                        int{places[n].high >= low});
    }
    return count;
  }

  /// The first piece of a row at `x` or to the right of it. The search starts at `guess`, which is
  /// always near, and goes to both sides.
  [[nodiscard]] std::uint32_t first_from(std::uint32_t guess, std::uint32_t row, std::uint32_t end,
                                         int x) const {
    while (guess < end && places_[guess].x < x) ++guess;
    while (guess > row && places_[guess - 1].x >= x) --guess;
    return guess;
  }

  /// Whether no point of one box can be near enough to one of the other.
  [[nodiscard]] bool are_apart(const Box<Scalar>& a, const Box<Scalar>& b) const {
    const Scalar widest = reach_at(std::min(a.farthest(), b.farthest()));
    return a.apart(b).squaredNorm() > widest * widest;
  }

  /// Whether a cell of one piece touches one of the other at most `reach` cells above or below it.
  [[nodiscard]] bool touch(std::uint32_t one, std::uint32_t other, int reach) const {
    const Piece<Scalar>&a = pieces_[one], &b = pieces_[other];
    if (are_apart(a.box, b.box)) return false;
    const int low = places_[other].low;
    for (std::uint32_t i = a.first; i < a.last; ++i) {
      // The cells of a piece have no gaps.
      const int from = std::max(cells_[i].z - reach, low), to = cells_[i].z + reach;
      for (std::uint32_t j = b.first + static_cast<std::uint32_t>(from - low);
           j < b.last && cells_[j].z <= to; ++j) {
        if (touch(cells_[i], cells_[j])) return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool touch(const Cell<Scalar>& a, const Cell<Scalar>& b) const {
    if (are_apart(a.box, b.box)) return false;
    for (std::uint32_t r = a.first; r < a.last; ++r) {
      for (std::uint32_t i = runs_[r].first; i < runs_[r].last; ++i) {
        if (touches(i, b)) return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool touches(std::uint32_t point, const Cell<Scalar>& cell) const {
    for (std::uint32_t r = cell.first; r < cell.last; ++r) {
      for (std::uint32_t i = runs_[r].first; i < runs_[r].last; ++i) {
        if (are_near(point, i)) return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool are_near(std::uint32_t one, std::uint32_t other) const {
    const Scalar near_enough = reach_at(std::min(ranges_[one], ranges_[other]));
    return (points_[one] - points_[other]).squaredNorm() <= near_enough * near_enough;
  }

  std::vector<int> numbered(DisjointSets& sets) const {
    std::vector<int> number_of(pieces_.size(), -1), numbers(points_.size());
    int next = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      int& number = number_of[piece_of_[i]];
      if (number < 0) {
        int& of_set = number_of[sets.root(piece_of_[i])];
        if (of_set < 0) of_set = next++;
        number = of_set;
      }
      numbers[i] = number;
    }
    return numbers;
  }

  const std::vector<Vector>& points_;
  const std::vector<Scalar>& ranges_;
  Scalar gap_, growth_, edge_;
  std::vector<Run> runs_;  ///< In order of their cells.
  std::vector<Cell<Scalar>> cells_;
  std::vector<Piece<Scalar>> pieces_;
  std::vector<Place> places_;            ///< Of each piece.
  std::vector<std::uint32_t> piece_of_;  ///< The piece of each point.
  std::vector<std::uint32_t> rows_;      ///< First piece of each row, and the end.
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
