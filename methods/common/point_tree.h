// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <nanoflann.hpp>
#include <vector>

namespace raymoval {

/// Finds the points nearest to a point.
/// @tparam Point has its coordinates as point(0), point(1), point(2)
template <class Point>
class PointTree {
 public:
  /// @param points must outlive the tree
  explicit PointTree(const std::vector<Point>& points)
      : table_{points}, index_(3, table_, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {
    index_.buildIndex();
  }
  PointTree(const PointTree&) = delete;
  PointTree& operator=(const PointTree&) = delete;

  /// Squares of the distances from `point` to the `squares.size()` points nearest to it, ascending.
  /// @param numbers as long as `squares`; gets the points' numbers
  void find_nearest(const Point& point, std::vector<std::uint32_t>& numbers,
                    std::vector<float>& squares) const {
    const float query[3] = {point(0), point(1), point(2)};
    index_.knnSearch(query, squares.size(), numbers.data(), squares.data());
  }

 private:
  /// The points in the shape that nanoflann reads.
  struct Table {
    const std::vector<Point>& points;
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return points[i](static_cast<unsigned>(axis));
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  Table table_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Table>, Table, 3> index_;
};

}  // namespace raymoval
