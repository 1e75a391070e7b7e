// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "methods/hmm_mos/parameters.h"

namespace raymoval::hmm_mos_method {

/// The hidden Markov model of one voxel. Of its three states the first, unobserved, has probability
/// 0 from the first observation on, so that one number is kept: the probability of occupied.
class BeliefModel {
 public:
  /// Before the first observation: as likely occupied as free, which is what a step from the state
  /// unobserved comes to.
  static constexpr double kUnobserved = 0.5;
  /// More squared distances than this are never told apart.
  static constexpr int kMostDistances = 254;

  /// @throws ConfigurationError if it would have to tell more than `kMostDistances` apart
  explicit BeliefModel(const Parameters& parameters);

  /// From this squared distance on, in voxels, all are alike: after an observation at it or farther
  /// off, occupied is so unlikely that the next step does not feel how much so, as double precision
  /// has it, and the state is free.
  [[nodiscard]] int far() const { return static_cast<int>(likelihood_.size()); }

  /// Step 4: the probability of occupied after one more observation.
  /// @param occupied the same before
  /// @param distance squared, in voxels, to the nearest occupied voxel; not above `far()`
  [[nodiscard]] double after(double occupied, int distance) const {
    if (distance == 0) return 1.0;
    if (distance >= far()) return 0.0;
    const double likelihood = likelihood_[static_cast<std::size_t>(distance)];
    const double stays = likelihood * (transition_ + keep_ * occupied);
    const double goes = (1.0 - likelihood) * (transition_ + keep_ * (1.0 - occupied));
    return stays / (stays + goes);
  }
  [[nodiscard]] bool is_occupied(double occupied) const { return occupied > belief_; }
  [[nodiscard]] bool is_free(double occupied) const { return 1.0 - occupied > belief_; }

 private:
  [[nodiscard]] bool is_far(double likelihood) const;

  double transition_, keep_, belief_;
  std::vector<double> likelihood_;  ///< p_o by squared distance.
};

}  // namespace raymoval::hmm_mos_method
