// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <nanoflann.hpp>
#include <vector>

namespace raymoval {

/// Finds the points nearest to a point.
/// @tparam Point has its coordinates as point(0), point(1), point(2)
/// @tparam Number of coordinates and squared distances
template <class Point, class Number = float>
class PointTree {
 public:
  /// @param points must outlive the tree
  explicit PointTree(const std::vector<Point>& points)
      : table_{points}, index_(3, table_, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}
  PointTree(const PointTree&) = delete;
  PointTree& operator=(const PointTree&) = delete;

  /// Squares of the distances from `query` to the `squares.size()` points nearest to it, ascending.
  /// @param query three coordinates
  /// @param numbers as long as `squares`; gets the points' numbers
  /// @return how many points there are, at most `squares.size()`
  std::size_t find_nearest(const Number* query, std::vector<std::uint32_t>& numbers,
                           std::vector<Number>& squares) const {
    return index_.knnSearch(query, squares.size(), numbers.data(), squares.data());
  }
  /// The point nearest to `query` among those within `reach`; null if there is none.
  const Point* nearest(const Number* query, Number reach) const {
    std::uint32_t number = 0;
    Number square = 0;
    nanoflann::KNNResultSet<Number, std::uint32_t> found(1);
    found.init(&number, &square);
    square = reach * reach;  // Of the present set. Points farther away are not searched.
    search(query, found);
    return found.size() == 0 ? nullptr : &table_.points[number];
  }
  /// Gives `result`, one of nanoflann's sets of results or like one, what a search meets.
  template <class Result>
  void search(const Number* query, Result& result) const {
    index_.findNeighbors(result, query, {});
  }

 private:
  /// The points in the shape that nanoflann reads.
  struct Table {
    const std::vector<Point>& points;
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] Number kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return static_cast<Number>(points[i](static_cast<unsigned>(axis)));
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  Table table_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<Number, Table>, Table, 3,
                                      std::uint32_t>
      index_;
};

}  // namespace raymoval
