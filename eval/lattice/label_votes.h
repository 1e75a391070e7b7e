// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "eval/points/labelled_voxels.h"

namespace raymoval {

/// The votes of many voxels at a time, for points in the order of their index, which are not
/// stored. The result equals that of `LabelVote`, at 16 bytes per voxel.
///
/// Only a point that is nearer than all earlier points can give its label, because otherwise an
/// earlier point is in reach, too. So a voxel stores the earliest of these points that is still in
/// reach of the nearest. Later points in reach are nearer by less than `kLabelTieMargin`. Few
/// voxels have such points, or a point of the other class in reach of the nearest; these are stored
/// apart.
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
  /// Bytes of memory, without the few voxels that store more than one point.
  [[nodiscard]] std::size_t bytes() const { return holders_.capacity() * sizeof(Candidate); }
  /// Whether a moving and a static point have the same distance.
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
  /// Distance of the nearest point of the other class than the nearest point, if it was in reach of
  /// the nearest point.
  std::unordered_map<std::size_t, double> other_class_;
};

}  // namespace raymoval
