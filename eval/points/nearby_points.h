// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace raymoval {

/// Points of the world frame (metres) that can be asked whether any lies within one fixed reach of
/// a query: a k-d tree, so that a query costs little more where thousands of scans saw one place.
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
