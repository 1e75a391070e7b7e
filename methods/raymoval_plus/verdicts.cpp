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

/// Dynamic votes in the upper half, all decided ones in the lower.
std::uint32_t vote_of(Evidence evidence) {
  if (evidence == Evidence::kUndecided) return 0;
  return evidence == Evidence::kDynamic ? 0x10001U : 1U;
}

/// Votes in a cube of cells: a block, and `radius` cells to either side of it.
class Ballot {
 public:
  explicit Ballot(int radius) : radius_(radius), side_(kSide + 2 * radius) {
    votes_.resize(static_cast<std::size_t>(side_ * side_ * side_));
    planes_.resize(static_cast<std::size_t>(side_ * side_ * kSide));
    rows_.resize(static_cast<std::size_t>(side_ * kSide * kSide));
  }
  void clear() { std::fill(votes_.begin(), votes_.end(), 0U); }
  /// Adds the votes of a block that lies `corner` cells from this one, where they are in the cube.
  void add(const VoxelIndex& corner, const Evidence* decisions) {
    const VoxelIndex low = (corner.array() + radius_).max(0);
    const VoxelIndex high = (corner.array() + radius_ + kSide).min(side_);
    for (int z = low.z(); z < high.z(); ++z) {
      for (int y = low.y(); y < high.y(); ++y) {
        const Evidence* const row =
            decisions + ((z - corner.z() - radius_) * kSide + y - corner.y() - radius_) * kSide;
        std::uint32_t* const votes = votes_.data() + (z * side_ + y) * side_;
        for (int x = low.x(); x < high.x(); ++x) votes[x] = vote_of(row[x - corner.x() - radius_]);
      }
    }
  }
  /// Sums the cube around each of the block's cells: planes first, then their rows, then cells.
  void count() {
    sum_windows(votes_.data(), side_ * side_, planes_.data());
    for (int z = 0; z < kSide; ++z) {
      sum_windows(planes_.data() + z * side_ * side_, side_, rows_.data() + z * kSide * side_);
    }
    for (int line = 0; line < kSide * kSide; ++line) {
      sum_windows(rows_.data() + line * side_, 1, sums_.data() + line * kSide);
    }
  }
  /// @param cell its place in the block
  [[nodiscard]] std::uint32_t around(std::size_t cell) const { return sums_[cell]; }

 private:
  /// Of `side_` slices of `size` votes each the sums of 2 `radius_` + 1 neighbours, `kSide` of
  /// them. Votes stay in their halves.
  void sum_windows(const std::uint32_t* slices, int size, std::uint32_t* sums) const {
    std::copy_n(slices, size, sums);
    for (int s = 1; s <= 2 * radius_; ++s) {
      for (int i = 0; i < size; ++i) sums[i] += slices[s * size + i];
    }
    for (int s = 1; s < kSide; ++s) {
      const std::uint32_t* const leaves = slices + (s - 1) * size;
      const std::uint32_t* const enters = slices + (s + 2 * radius_) * size;
      for (int i = 0; i < size; ++i) {
        sums[s * size + i] = sums[(s - 1) * size + i] - leaves[i] + enters[i];
      }
    }
  }

  int radius_, side_;
  std::vector<std::uint32_t> votes_, planes_, rows_;
  std::array<std::uint32_t, EvidenceMap::Blocks::kCells> sums_{};
};

/// Replaces `around` with the blocks around a block, itself included.
void find_around(const EvidenceMap& map, std::uint32_t block, int reach,
                 std::vector<std::uint32_t>& around) {
  around.clear();
  const VoxelIndex& center = map.blocks().block_index(block);
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const std::uint32_t other = map.blocks().block(center + VoxelIndex(x, y, z));
        if (other != EvidenceMap::kNone) around.push_back(other);
      }
    }
  }
}

/// Calls `visit(voxel, cell)` for each voxel of a block.
template <class Visit>
void for_voxels(const EvidenceMap& map, std::uint32_t block, Visit&& visit) {
  const std::uint32_t* const cells = map.blocks().cells(block);
  for (std::size_t i = 0; i < EvidenceMap::Blocks::kCells; ++i) {
    if (cells[i] != EvidenceMap::kNone) visit(cells[i], i);
  }
}

/// What a voxel's own decision becomes among its neighbours.
Evidence outvoted(Evidence decision, std::uint32_t votes,
                  const RaymovalPlusParameters& parameters) {
  const double decided = votes & 0xFFFFU, dynamic = votes >> 16U;
  if (decided == 0) return Evidence::kUndecided;
  const double share =
      decision == Evidence::kDynamic ? parameters.vote_keep : parameters.vote_share;
  return dynamic >= share * decided ? Evidence::kDynamic : Evidence::kStatic;
}

void vote_in_block(std::uint32_t block, const RaymovalPlusParameters& parameters, int radius,
                   Ballot& ballot, std::vector<std::uint32_t>& around, EvidenceMap& map) {
  find_around(map, block, (radius + kSide - 1) / kSide, around);
  if (std::none_of(around.begin(), around.end(),
                   [&](std::uint32_t other) { return map.dynamic_in(other) > 0; })) {
    for_voxels(map, block,
               [&](std::uint32_t v, std::size_t) { map.set_verdict(v, map.decision(v)); });
    return;
  }
  const VoxelIndex center = map.blocks().block_index(block);
  ballot.clear();
  for (const std::uint32_t other : around) {
    ballot.add((map.blocks().block_index(other) - center) * kSide, map.decisions(other));
  }
  ballot.count();
  for_voxels(map, block, [&](std::uint32_t v, std::size_t cell) {
    const Evidence decision = map.decision(v);
    map.set_verdict(v, was_always_there(map.evidence(v), parameters)
                           ? decision
                           : outvoted(decision, ballot.around(cell), parameters));
  });
}

}  // namespace

void vote(const std::vector<std::uint32_t>& blocks, const RaymovalPlusParameters& parameters,
          int threads, EvidenceMap& map) {
  const int radius = std::min(parameters.vote_radius, kMaximumRadius);
  parallel_chunks(threads, blocks.size(), 256, [&](std::size_t begin, std::size_t end) {
    Ballot ballot(radius);
    std::vector<std::uint32_t> around;
    for (std::size_t i = begin; i < end; ++i) {
      vote_in_block(blocks[i], parameters, radius, ballot, around, map);
    }
  });
}

}  // namespace raymoval
