// SPDX-License-Identifier: MIT
#include "eval/nearby_points.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/text.h"
#include "eval/cell_sort.h"

namespace raymoval {
namespace {

/// Smaller cells than this would only shrink the world that 64-bit keys can name.
constexpr double kSmallestEdge = 0.2;

}  // namespace

template <class Point>
NearbyPoints<Point>::NearbyPoints(const std::vector<Point>& points, double reach)
    : reach_(reach), inverse_edge_(1.0 / std::max(4.0 * reach, kSmallestEdge)) {
  if (points.size() >= std::numeric_limits<std::uint32_t>::max()) {
    throw DataError("a map of " + grouped_text(points.size()) +
                    " points is too large to search: expected fewer than 4,294,967,295. Use fewer "
                    "scans.");
  }
  std::vector<CellPoint> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    order[i] = {voxel_key(voxel_index(points[i].template cast<double>(), inverse_edge_)),
                static_cast<std::uint32_t>(i)};
  }
  sort_by_cell(order);
  points_.reserve(order.size());
  for (const CellPoint& item : order) {
    const auto at = static_cast<std::uint32_t>(points_.size());
    const auto [cell, added] = cells_.insert({item.key, Span{at, at}});
    cell.value().end = at + 1;
    points_.push_back({points[item.point], item.point});
  }
}

template class NearbyPoints<Eigen::Vector3d>;
template class NearbyPoints<Eigen::Vector3f>;

}  // namespace raymoval
