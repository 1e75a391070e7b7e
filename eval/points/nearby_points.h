// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace raymoval {

/// Answers whether any of many points lies within a fixed reach of a query point. The points are in
/// the world frame, in metres. They stand in a k-d tree, so that a query costs little more at a
/// place that thousands of scans saw.
/// @tparam Point Eigen::Vector3d or Eigen::Vector3f; distances are in double
template <class Point>
class NearbyPoints {
 public:
  /// @param points must outlive this object
  /// @param reach metres
  NearbyPoints(const std::vector<Point>& points, double reach);
  ~NearbyPoints();
  NearbyPoints(const NearbyPoints&) = delete;
  NearbyPoints& operator=(const NearbyPoints&) = delete;

  /// Whether the squared distance of any point from `query` is at most `reach` squared.
  [[nodiscard]] bool has_near(const Eigen::Vector3d& query) const;

 private:
  struct Tree;
  double squared_reach_;
  std::unique_ptr<const Tree> tree_;  ///< Null without points.
};

extern template class NearbyPoints<Eigen::Vector3d>;
extern template class NearbyPoints<Eigen::Vector3f>;

}  // namespace raymoval
