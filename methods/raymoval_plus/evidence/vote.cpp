// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/vote.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "methods/raymoval_plus/evidence/evidence.h"

namespace raymoval::raymoval_plus_method {
namespace {

constexpr int kSide = EvidenceMap::Blocks::kSideXY;
/// Blocks that a thread takes at a time: with fewer it would allocate its sums more often.
constexpr std::size_t kBlocksATask = 256;

/// A sum of votes has the number of dynamic voxels in its upper 16 bits and the number of all
/// decided voxels in the lower ones. A cube of the largest radius has 17^3 = 4,913 cells, which
/// fits.
/// These are the votes of an undecided, a static and a dynamic voxel.
constexpr std::array<std::uint32_t, 3> kVotes = {0, 1, 0x10001U};

/// The votes around the cells of a block: those in a cube of cells that holds the
/// block and `radius` cells to either side of it.
class Ballot {
 public:
  explicit Ballot(int radius) : radius_(radius), side_(kSide + 2 * radius) {
    votes_.resize(static_cast<std::size_t>(side_ * side_ * side_));
    planes_.resize(static_cast<std::size_t>(side_ * side_ * kSide));
    rows_.resize(static_cast<std::size_t>(side_ * kSide * kSide));
  }
  void clear() { std::fill(votes_.begin(), votes_.end(), 0U); }
  /// Adds those votes of another block that lie in the cube. @param step blocks from this one to it
  void add(const VoxelIndex& step, const Verdict* decisions) {
    const VoxelIndex corner = step * kSide;
    const VoxelIndex low = (corner.array() + radius_).max(0);
    const VoxelIndex high = (corner.array() + radius_ + kSide).min(side_);
    for (int z = low.z(); z < high.z(); ++z) {
      for (int y = low.y(); y < high.y(); ++y) {
        const Verdict* const row =
            decisions + ((z - corner.z() - radius_) * kSide + y - corner.y() - radius_) * kSide;
        std::uint32_t* const votes = votes_.data() + (z * side_ + y) * side_;
        for (int x = low.x(); x < high.x(); ++x) {
          votes[x] = kVotes[static_cast<std::size_t>(row[x - corner.x() - radius_])];
        }
      }
    }
  }
  /// Sums the votes around each of the block's cells: over planes, then over their rows, then over
  /// the cells of a row.
  void count() {
    sum_windows(votes_.data(), side_ * side_, planes_.data());
    for (int z = 0; z < kSide; ++z) {
      sum_windows(planes_.data() + z * side_ * side_, side_, rows_.data() + z * kSide * side_);
    }
    for (int line = 0; line < kSide * kSide; ++line) {
      sum_windows(rows_.data() + line * side_, 1, sums_.data() + line * kSide);
    }
  }
  /// The votes within `radius` cells of one of the block's cells, given its place in the block.
  [[nodiscard]] std::uint32_t around(std::size_t cell) const { return sums_[cell]; }

 private:
  /// There are `side_` slices of `size` votes each. `sums` becomes `kSide` slices, each the sum of
  /// 2 `radius_` + 1 slices in a row: the next is the last one, less what leaves, plus what enters.
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

/// The verdict on a voxel, from its own decision and the votes around it.
Verdict verdict_by_votes(Verdict decision, std::uint32_t votes, const Parameters& parameters) {
  const double decided = votes & 0xFFFFU, dynamic = votes >> 16U;
  if (decided == 0) return Verdict::kUndecided;
  const double share = decision == Verdict::kDynamic ? parameters.vote_keep : parameters.vote_share;
  return dynamic >= share * decided ? Verdict::kDynamic : Verdict::kStatic;
}

void vote_in_block(std::uint32_t block, int reach, const Parameters& parameters, Ballot& ballot,
                   EvidenceMap& map) {
  if (!map.is_near_dynamic(block)) {
    map.take_decisions(block);
    return;
  }
  const VoxelIndex center = map.blocks().block_index(block);
  ballot.clear();
  map.blocks().for_blocks_around(block, reach, [&](std::uint32_t other) {
    ballot.add(map.blocks().block_index(other) - center, map.decisions(other));
  });
  ballot.count();
  const Verdict* const decisions = map.decisions(block);
  const std::size_t first_slot = block * EvidenceMap::Blocks::kCells;
  for_voxels(map, block, [&](std::uint32_t v, std::size_t cell) {
    const Verdict voted = verdict_by_votes(decisions[cell], ballot.around(cell), parameters);
    // The evidence is far away in memory, and only asked where the vote changes something.
    const bool stays = voted != decisions[cell] && is_firm(map.evidence(v));
    map.set_verdict_in(first_slot + cell, stays ? decisions[cell] : voted);
  });
}

}  // namespace

void vote(const std::vector<std::uint32_t>& blocks, const Parameters& parameters,
          const RunContext& context, EvidenceMap& map) {
  const StageScope timed(context.times, "vote");
  const int reach = (parameters.vote_radius + kSide - 1) / kSide;
  map.update_surroundings(reach);
  parallel_chunks(context.threads, blocks.size(), kBlocksATask,
                  [&](std::size_t begin, std::size_t end) {
                    Ballot ballot(parameters.vote_radius);
                    for (std::size_t i = begin; i < end; ++i) {
                      vote_in_block(blocks[i], reach, parameters, ballot, map);
                    }
                  });
}

void vote(const Parameters& parameters, const RunContext& context, EvidenceMap& map) {
  std::vector<std::uint32_t> blocks(map.blocks().block_count());
  std::iota(blocks.begin(), blocks.end(), 0U);
  vote(blocks, parameters, context, map);
}

std::vector<std::uint32_t> blocks_of(const std::vector<std::uint32_t>& voxels,
                                     const EvidenceMap& map) {
  std::vector<std::uint8_t> is_found(map.blocks().block_count(), 0);
  std::vector<std::uint32_t> blocks;
  for (const std::uint32_t voxel : voxels) {
    if (voxel == EvidenceMap::kNone) continue;
    const std::uint32_t block = map.block_of(voxel);
    if (std::exchange(is_found[block], std::uint8_t{1}) == 0) blocks.push_back(block);
  }
  return blocks;
}

}  // namespace raymoval::raymoval_plus_method
