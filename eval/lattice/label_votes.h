// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "eval/points/labelled_voxels.h"

namespace raymoval {

/// The votes of many voxels at a time, for points that come in the order of their index and are not
/// kept: what `LabelVote` decides, at 16 bytes a voxel.
///
/// Of points in order, only one that is nearer than all before it can ever give its label: with any
/// other one an earlier point is in reach, too. So a voxel remembers the earliest of these that is
/// still in reach of the nearest. Those that came after it, and are in reach likewise, are nearer
/// by less than `kLabelTieMargin`; the few voxels that have any remember them apart. So do those
/// that have a point of the other class in reach of the nearest.
class LabelVotes {
 public:
  struct Label {
    std::uint16_t id = 0;  ///< Semantic id of the point.
    std::uint32_t scan = 0;
  };

  explicit LabelVotes(std::size_t voxels) : holders_(voxels) {}

  /// Offers the next point to a voxel. @param distance from the voxel's mean, metres
  void offer(std::size_t voxel, double distance, const Label& label, bool moves);

  /// The label of the nearest point, or of the first one in reach of it. The voxel was offered one.
  [[nodiscard]] Label label(std::size_t voxel) const {
    return {holders_[voxel].id, holders_[voxel].scan};
  }
  /// What they take in memory, but for the few voxels that remember more than one point.
  [[nodiscard]] std::size_t bytes() const { return holders_.capacity() * sizeof(Candidate); }
  /// Whether a moving and a static point stand at the same distance.
  [[nodiscard]] bool is_mixed_tie(std::size_t voxel) const;

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  struct Candidate {
    double distance = kFar;
    std::uint32_t scan = 0;
    std::uint16_t id = 0;
    bool moves = false;
    bool has_more = false;  ///< Of a holder: its voxel has an entry in `behind_`.
  };
  static_assert(sizeof(Candidate) == 16);

  [[nodiscard]] Candidate nearest(std::size_t voxel) const;
  void take_lead(std::size_t voxel, const Candidate& candidate);

  std::vector<Candidate> holders_;
  /// Candidates behind the holder, in order: each is nearer than the one before it.
  std::unordered_map<std::size_t, std::vector<Candidate>> behind_;
  /// Distance of the nearest point of the class that the nearest point of all is not of, where it
  /// was in reach of this one.
  std::unordered_map<std::size_t, double> other_class_;
};

}  // namespace raymoval
