// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/belief.h"

#include <cmath>

namespace raymoval::hmm_mos_method {

BeliefModel::BeliefModel(const Parameters& parameters)
    : transition_(parameters.transition),
      keep_(1.0 - 2.0 * parameters.transition),
      belief_(parameters.belief) {
  for (int distance = 0;; ++distance) {
    const double likelihood = std::exp(-distance / (2.0 * parameters.spread * parameters.spread));
    if (is_far(likelihood)) return;
    likelihood_.push_back(likelihood);
    if (far() > kMostDistances) {
      throw ConfigurationError(
          "hmm_mos.spread and hmm_mos.transition: distances would count too far away; expected a "
          "smaller spread, or a larger transition.");
    }
  }
}

bool BeliefModel::is_far(double likelihood) const {
  // At worst, occupied is as likely before as it can be. What comes out falls with the distance.
  const double stays = likelihood * (1.0 - transition_), goes = (1.0 - likelihood) * transition_;
  const double occupied = stays / (stays + goes);
  return 1.0 - occupied == 1.0 && transition_ + keep_ * occupied == transition_;
}

}  // namespace raymoval::hmm_mos_method
