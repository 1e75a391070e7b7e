// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <nanoflann.hpp>
#include <vector>

namespace raymoval::registration {

inline const Eigen::Vector3f& position_of(const Eigen::Vector3f& point) {
  return point;
}

/// Points in the form that nanoflann reads.
/// @tparam Point has a function `position_of`
template <class Point>
struct PointTable {
  const std::vector<Point>& points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return position_of(points[i])[static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

template <class Point>
using PointKdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointTable<Point>>,
                                        PointTable<Point>, 3, std::uint32_t>;

}  // namespace raymoval::registration
