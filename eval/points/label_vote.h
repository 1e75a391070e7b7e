// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "eval/points/labelled_voxels.h"

namespace raymoval {

/// Picks the point that hands its label to a query: the nearest one, or the lowest index among
/// those within `kLabelTieMargin` of the nearest. Points may be offered in any order.
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
    bool mixed_tie;  ///< A moving and a static point stood at the same distance.
  };
  /// @param moving_of says whether point i moves
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

}  // namespace raymoval
