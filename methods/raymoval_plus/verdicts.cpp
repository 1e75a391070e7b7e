// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/verdicts.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "methods/raymoval_plus/evidence.h"

namespace raymoval {
namespace {

constexpr int kSide = EvidenceMap::Blocks::kSideXY;
constexpr int kMaximumRadius = 2 * kSide;  // Two blocks to either side are looked at.

/// Votes in a cube of cells around a block.
class Ballot {
 public:
  explicit Ballot(int radius) : radius_(radius), side_(kSide + 2 * radius) {
    const auto cells = static_cast<std::size_t>(side_ * side_ * side_);
    votes_.resize(cells);
    sums_.resize(cells);
  }
  void clear() { std::fill(votes_.begin(), votes_.end(), 0U); }
  /// Adds a vote at a cell relative to the block's lower corner; ignored outside the cube.
  void add(const VoxelIndex& cell, std::uint32_t vote) {
    const VoxelIndex at = cell.array() + radius_;
    if ((at.array() < 0).any() || (at.array() >= side_).any()) return;
    votes_[offset(at.x(), at.y(), at.z())] = vote;
  }
  /// Sums the cube around each of the block's cells, one axis after the other.
  void count() {
    const int plane = side_ * side_;
    sum_along(1, side_, plane);
    sum_along(side_, 1, plane);
    sum_along(plane, 1, side_);
  }
  [[nodiscard]] std::uint32_t around(const VoxelIndex& cell) const {
    return votes_[offset(cell.x() + radius_, cell.y() + radius_, cell.z() + radius_)];
  }

 private:
  [[nodiscard]] std::size_t offset(int x, int y, int z) const {
    return static_cast<std::size_t>((z * side_ + y) * side_ + x);
  }
  /// Replaces each cell of the lines along `step` by the sum of `radius_` cells to either side;
  /// the other strides say where the lines begin. Votes stay in their halves.
  void sum_along(int step, int stride, int other_stride) {
    for (int line = 0; line < side_ * side_; ++line) {
      const int begin = (line % side_) * stride + (line / side_) * other_stride;
      const std::uint32_t* const from = votes_.data() + begin;
      std::uint32_t* const to = sums_.data() + begin;
      std::uint32_t sum = 0;
      for (int c = 0; c < 2 * radius_; ++c) sum += from[c * step];
      for (int c = radius_; c < side_ - radius_; ++c) {
        sum += from[(c + radius_) * step];
        to[c * step] = sum;
        sum -= from[(c - radius_) * step];
      }
    }
    std::swap(votes_, sums_);
  }

  int radius_, side_;
  std::vector<std::uint32_t> votes_, sums_;
};

/// Dynamic votes in the upper half, all decided ones in the lower.
std::uint32_t vote_of(Evidence evidence) {
  if (evidence == Evidence::kUndecided) return 0;
  return evidence == Evidence::kDynamic ? 0x10001U : 1U;
}

/// Blocks around a block, itself included.
std::vector<std::uint32_t> blocks_around(const EvidenceMap& map, std::uint32_t block, int reach) {
  std::vector<std::uint32_t> around;
  const VoxelIndex& center = map.blocks().block_index(block);
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const std::uint32_t other = map.blocks().block(center + VoxelIndex(x, y, z));
        if (other != EvidenceMap::kNone) around.push_back(other);
      }
    }
  }
  return around;
}

/// Calls `visit(voxel)` for each voxel of a block.
template <class Visit>
void for_voxels(const EvidenceMap& map, std::uint32_t block, Visit&& visit) {
  const std::uint32_t* const cells = map.blocks().cells(block);
  for (std::size_t i = 0; i < EvidenceMap::Blocks::kCells; ++i) {
    if (cells[i] != EvidenceMap::kNone) visit(cells[i]);
  }
}

void vote_in_block(std::uint32_t block, const RaymovalPlusParameters& parameters, int radius,
                   Ballot& ballot, EvidenceMap& map) {
  const auto around = blocks_around(map, block, (radius + kSide - 1) / kSide);
  if (std::none_of(around.begin(), around.end(),
                   [&](std::uint32_t other) { return map.dynamic_in(other) > 0; })) {
    for_voxels(map, block, [&](std::uint32_t v) { map.set_verdict(v, map.decision(v)); });
    return;
  }
  const VoxelIndex corner = map.blocks().block_index(block) * kSide;
  ballot.clear();
  for (const std::uint32_t other : around) {
    for_voxels(map, other, [&](std::uint32_t v) {
      ballot.add(map.index(v) - corner, vote_of(map.decision(v)));
    });
  }
  ballot.count();
  for_voxels(map, block, [&](std::uint32_t v) {
    if (was_always_there(map.evidence(v), parameters)) {
      map.set_verdict(v, map.decision(v));
      return;
    }
    const std::uint32_t votes = ballot.around(map.index(v) - corner);
    const double decided = votes & 0xFFFFU, dynamic = votes >> 16U;
    const double share =
        map.decision(v) == Evidence::kDynamic ? parameters.vote_keep : parameters.vote_share;
    map.set_verdict(v, decided == 0                 ? Evidence::kUndecided
                       : dynamic >= share * decided ? Evidence::kDynamic
                                                    : Evidence::kStatic);
  });
}

}  // namespace

void vote(const std::vector<std::uint32_t>& blocks, const RaymovalPlusParameters& parameters,
          int threads, EvidenceMap& map) {
  const int radius = std::min(parameters.vote_radius, kMaximumRadius);
  parallel_chunks(threads, blocks.size(), 256, [&](std::size_t begin, std::size_t end) {
    Ballot ballot(radius);
    for (std::size_t i = begin; i < end; ++i) {
      vote_in_block(blocks[i], parameters, radius, ballot, map);
    }
  });
}

}  // namespace raymoval
