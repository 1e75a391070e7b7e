// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "eval/points/labelled_voxels.h"

namespace raymoval {

/// Selects the point that gives its label to a query: the point with the lowest index among points
/// within `kLabelTieMargin` of the nearest. Points may be offered in any order.
class LabelVote {
 public:
  void clear() {
    candidates_.clear();
    nearest_ = std::numeric_limits<double>::infinity();
  }
  void offer(double squared_distance, std::uint32_t point) {
    const double distance = std::sqrt(squared_distance);
    if (distance > nearest_ + kLabelTieMargin) return;
    if (distance < nearest_) nearest_ = distance;
    candidates_.push_back({distance, point});
  }
  /// Farthest distance at which an offer can still matter; infinite before the first offer.
  [[nodiscard]] double reach() const { return nearest_ + kLabelTieMargin; }

  struct Result {
    std::uint32_t point;
    bool mixed_tie;  ///< A moving and a static point had the same distance.
  };
  /// @param moving_of whether point i moves
  template <class MovingOf>
  [[nodiscard]] Result decide(MovingOf&& moving_of) const {
    std::uint32_t lowest = std::numeric_limits<std::uint32_t>::max();
    bool any_moving = false, any_static = false;
    for (const Candidate& candidate : candidates_) {
      if (candidate.distance > reach()) continue;
      if (candidate.point < lowest) lowest = candidate.point;
      (moving_of(candidate.point) ? any_moving : any_static) = true;
    }
    return {lowest, any_moving && any_static};
  }

 private:
  struct Candidate {
    double distance;
    std::uint32_t point;
  };
  std::vector<Candidate> candidates_;
  double nearest_ = std::numeric_limits<double>::infinity();
};

/// Finds out whether any of many points lies within a fixed reach of a query point. The points are
/// in the world frame, in metres. They are in a k-d tree, so that a query costs little more at a
/// place that thousands of scans observed.
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

/// Gives query points the label of their exact nearest neighbour, at any distance.
class NearestLabels {
 public:
  /// Keeps `cloud`, which needs at least one point.
  explicit NearestLabels(LabelledCloud cloud);
  ~NearestLabels();
  NearestLabels(const NearestLabels&) = delete;
  NearestLabels& operator=(const NearestLabels&) = delete;

  /// The label of the nearest point of each query point. Among points within `kLabelTieMargin` of
  /// the nearest one, the point with the lowest index gives the label. The number of threads does
  /// not change the answer.
  [[nodiscard]] std::vector<std::uint32_t> labels_of(const std::vector<Eigen::Vector3d>& queries,
                                                     int threads) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace raymoval
