// SPDX-License-Identifier: MIT
#include "eval/lattice/label_votes.h"

#include <algorithm>

namespace raymoval {

void LabelVotes::offer(std::size_t voxel, double distance, const Label& label, bool moves) {
  Vote& vote = votes_[voxel];
  const double nearest = std::min(vote.nearest_static, vote.nearest_moving);
  if (distance > nearest + kLabelTieMargin) return;
  double& of_class = moves ? vote.nearest_moving : vote.nearest_static;
  of_class = std::min(of_class, distance);
  if (distance >= nearest) return;
  const double reach = distance + kLabelTieMargin;
  const auto found = behind_.find(voxel);
  if (vote.holder.distance <= reach) {
    behind_[voxel].push_back({distance, label});
  } else if (found == behind_.end()) {
    vote.holder = {distance, label};
  } else {
    std::vector<Candidate>& behind = found->second;
    behind.push_back({distance, label});
    const auto holder = std::find_if(behind.begin(), behind.end(), [reach](const Candidate& one) {
      return one.distance <= reach;
    });
    vote.holder = *holder;
    behind.erase(behind.begin(), holder + 1);
    if (behind.empty()) behind_.erase(found);
  }
}

bool LabelVotes::is_mixed_tie(std::size_t voxel) const {
  const Vote& vote = votes_[voxel];
  const auto [low, high] = std::minmax(vote.nearest_static, vote.nearest_moving);
  return high <= low + kLabelTieMargin && high < kFar;
}

}  // namespace raymoval
