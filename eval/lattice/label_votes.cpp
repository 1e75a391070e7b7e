// SPDX-License-Identifier: MIT
#include "eval/lattice/label_votes.h"

#include <algorithm>

namespace raymoval {

LabelVotes::Candidate LabelVotes::nearest(std::size_t voxel) const {
  const Candidate& holder = holders_[voxel];
  return holder.has_more ? behind_.at(voxel).back() : holder;
}

void LabelVotes::offer(std::size_t voxel, double distance, const Label& label, bool moves) {
  const Candidate last = nearest(voxel);
  if (distance > last.distance + kLabelTieMargin) return;
  if (distance >= last.distance) {
    if (moves == last.moves) return;
    const auto [noted, is_new] = other_class_.try_emplace(voxel, distance);
    if (!is_new) noted->second = std::min(noted->second, distance);
    return;
  }
  if (moves != last.moves) {
    // All points of the new other class are at least as far away as the last.
    if (last.distance <= distance + kLabelTieMargin) {
      other_class_[voxel] = last.distance;
    } else if (!other_class_.empty()) {
      other_class_.erase(voxel);
    }
  }
  take_lead(voxel, {distance, label.scan, label.id, moves});
}

/// Stores a candidate that is nearer than all earlier candidates.
void LabelVotes::take_lead(std::size_t voxel, const Candidate& candidate) {
  Candidate& holder = holders_[voxel];
  const double reach = candidate.distance + kLabelTieMargin;
  if (holder.distance <= reach) {
    behind_[voxel].push_back(candidate);
    holder.has_more = true;
  } else if (!holder.has_more) {
    holder = candidate;
  } else {
    const auto found = behind_.find(voxel);
    std::vector<Candidate>& behind = found->second;
    behind.push_back(candidate);
    const auto next = std::find_if(behind.begin(), behind.end(),
                                   [reach](const Candidate& one) { return one.distance <= reach; });
    holder = *next;
    behind.erase(behind.begin(), next + 1);
    holder.has_more = !behind.empty();
    if (behind.empty()) behind_.erase(found);
  }
}

bool LabelVotes::is_mixed_tie(std::size_t voxel) const {
  const auto other = other_class_.find(voxel);
  return other != other_class_.end() && other->second <= nearest(voxel).distance + kLabelTieMargin;
}

}  // namespace raymoval
