// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/vote.h"

#include <algorithm>
#include <array>
#include <cstring>
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

/// The votes around the cells of a block, for any radius: those in a cube of cells that holds the
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

/// The same for the usual radius, which is one cell less than a block has along each axis: what is
/// within it is the block, and the upper or lower ends of those beside it. Sums run along x, then
/// z, then y, with the four cells of a row, or the numbers of both kinds, in one word.
class NearBallot {
 public:
  static constexpr int kRadius = kSide - 1;
  explicit NearBallot(int /*radius*/) {}
  void clear() { is_there_.fill(0); }
  /// @param step blocks from this one to the other one, at most 1 along each axis
  void add(const VoxelIndex& step, const Verdict* decisions) {
    const auto number =
        static_cast<std::size_t>((step.z() + 1) * 9 + (step.y() + 1) * 3 + step.x() + 1);
    is_there_[number] = 1;
    static_assert(sizeof(Rows) == EvidenceMap::Blocks::kCells * sizeof(Verdict));
    std::memcpy(blocks_[number].data(), decisions, sizeof(Rows));
  }
  void count() {
    for (std::size_t aside = 0; aside < 3; ++aside) sum_columns(aside);
    sum_rows();
  }
  [[nodiscard]] std::uint32_t around(std::size_t cell) const { return sums_[cell]; }

 private:
  static_assert(kSide == 4);
  /// The rows of a block, y before z: a byte for each of the four cells of a row.
  using Rows = std::array<std::uint32_t, std::size_t{kSide} * kSide>;

  /// Sums along x over the blocks from `first` on, if they are there. A byte has the number of
  /// dynamic voxels in its upper half and that of all decided ones in the lower half, at most 7.
  [[nodiscard]] Rows sum_along_x(std::size_t first) const {
    Rows sums{};
    const auto votes = [](std::uint32_t decisions) {
      return ((decisions | decisions >> 1U) & 0x01010101U) | (decisions & 0x02020202U) << 3U;
    };
    const auto up_to_each = [&](std::uint32_t decisions) {
      const std::uint32_t pairs = votes(decisions) + (votes(decisions) << 8U);
      return pairs + (pairs << 16U);
    };
    const auto last_of_each = [](std::uint32_t row) {
      const std::uint32_t twice = row >> 24U | row >> 24U << 8U;
      return twice | twice << 16U;
    };
    if (is_there_[first] != 0) {
      for (std::size_t r = 0; r < sums.size(); ++r) {
        const std::uint32_t before = up_to_each(blocks_[first][r]);
        sums[r] = last_of_each(before) - before;
      }
    }
    if (is_there_[first + 1] != 0) {
      for (std::size_t r = 0; r < sums.size(); ++r) {
        sums[r] += last_of_each(up_to_each(blocks_[first + 1][r]));
      }
    }
    if (is_there_[first + 2] != 0) {
      for (std::size_t r = 0; r < sums.size(); ++r)
        sums[r] += up_to_each(blocks_[first + 2][r]) << 8U;
    }
    return sums;
  }

  /// Sums along x and z over the blocks `aside` along y.
  void sum_columns(std::size_t aside) {
    std::array<std::uint32_t, 3 * Rows().size()> decided, dynamic;
    for (std::size_t level = 0; level < 3; ++level) {
      const Rows rows = sum_along_x(level * 9 + aside * 3);
      for (std::size_t r = 0; r < rows.size(); ++r) {
        decided[level * rows.size() + r] = rows[r] & 0x0F0F0F0FU;
        dynamic[level * rows.size() + r] = rows[r] >> 4U & 0x0F0F0F0FU;
      }
    }
    // A window of seven planes of four rows each.
    sum_windows(decided.data() + kSide, decided_[aside]);
    sum_windows(dynamic.data() + kSide, dynamic_[aside]);
  }
  static void sum_windows(const std::uint32_t* planes, Rows& sums) {
    constexpr std::size_t kWindow = 2 * kRadius + 1;
    std::array<std::uint32_t, kSide> sum{};
    for (std::size_t plane = 0; plane < kWindow; ++plane) {
      for (std::size_t y = 0; y < kSide; ++y) sum[y] += planes[plane * kSide + y];
    }
    for (std::size_t z = 0; z < kSide; ++z) {
      for (std::size_t y = 0; y < kSide; ++y) {
        sums[z * kSide + y] = sum[y];
        if (z + 1 < kSide) sum[y] += planes[(z + kWindow) * kSide + y] - planes[z * kSide + y];
      }
    }
  }

  /// Sums along y: seven rows of sums along x and z.
  void sum_rows() {
    for (std::size_t z = 0; z < kSide; ++z) {
      std::array<std::array<std::uint32_t, kSide>, 3 * kSide> rows;
      for (std::size_t y = 0; y < rows.size(); ++y) {
        const std::uint32_t decided = decided_[y / kSide][z * kSide + y % kSide];
        const std::uint32_t dynamic = dynamic_[y / kSide][z * kSide + y % kSide];
        for (std::size_t x = 0; x < kSide; ++x) {
          rows[y][x] = (decided >> 8U * x & 0xFFU) | (dynamic >> 8U * x & 0xFFU) << 16U;
        }
      }
      std::array<std::uint32_t, kSide> sum{};
      for (std::size_t y = 1; y < 2 * kSide; ++y) {
        for (std::size_t x = 0; x < kSide; ++x) sum[x] += rows[y][x];
      }
      for (std::size_t y = 0; y < kSide; ++y) {
        for (std::size_t x = 0; x < kSide; ++x) {
          sums_[(z * kSide + y) * kSide + x] = sum[x];
          if (y + 1 < kSide) sum[x] += rows[y + 2 * kSide][x] - rows[y + 1][x];
        }
      }
    }
  }

  std::array<std::uint8_t, 27> is_there_{};  ///< Blocks, x fastest, then y, then z.
  std::array<Rows, 27> blocks_;              ///< Their decisions.
  std::array<Rows, 3> decided_, dynamic_;    ///< By y: sums along x and z, at most 49.
  std::array<std::uint32_t, EvidenceMap::Blocks::kCells> sums_{};
};

/// Calls `visit(voxel, cell)` for each voxel of a block; `cell` is its place in the block.
template <class Visit>
void for_voxels(const EvidenceMap& map, std::uint32_t block, Visit&& visit) {
  const std::uint32_t* const cells = map.blocks().cells(block);
  for (std::size_t i = 0; i < EvidenceMap::Blocks::kCells; ++i) {
    if (cells[i] != EvidenceMap::kNone) visit(cells[i], i);
  }
}

/// The verdict on a voxel, from its own decision and the votes around it.
Verdict verdict_by_votes(Verdict decision, std::uint32_t votes, const Parameters& parameters) {
  const double decided = votes & 0xFFFFU, dynamic = votes >> 16U;
  if (decided == 0) return Verdict::kUndecided;
  const double share = decision == Verdict::kDynamic ? parameters.vote_keep : parameters.vote_share;
  return dynamic >= share * decided ? Verdict::kDynamic : Verdict::kStatic;
}

template <class SomeBallot>
void vote_in_block(std::uint32_t block, int reach, const Parameters& parameters, SomeBallot& ballot,
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

template <class SomeBallot>
void vote_in_blocks(const std::vector<std::uint32_t>& blocks, const Parameters& parameters,
                    const RunContext& context, EvidenceMap& map) {
  const int reach = (parameters.vote_radius + kSide - 1) / kSide;
  map.update_surroundings(reach);
  parallel_chunks(context.threads, blocks.size(), kBlocksATask,
                  [&](std::size_t begin, std::size_t end) {
                    SomeBallot ballot(parameters.vote_radius);
                    for (std::size_t i = begin; i < end; ++i) {
                      vote_in_block(blocks[i], reach, parameters, ballot, map);
                    }
                  });
}

}  // namespace

void vote(const std::vector<std::uint32_t>& blocks, const Parameters& parameters,
          const RunContext& context, EvidenceMap& map) {
  const StageScope timed(context.times, "vote");
  if (parameters.vote_radius == NearBallot::kRadius) {
    vote_in_blocks<NearBallot>(blocks, parameters, context, map);
  } else {
    vote_in_blocks<Ballot>(blocks, parameters, context, map);
  }
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

std::vector<std::uint32_t> voxels_of(const std::vector<std::uint32_t>& blocks,
                                     const EvidenceMap& map) {
  std::vector<std::uint32_t> voxels;
  for (const std::uint32_t block : blocks) {
    for_voxels(map, block, [&](std::uint32_t voxel, std::size_t) { voxels.push_back(voxel); });
  }
  return voxels;
}

}  // namespace raymoval::raymoval_plus_method
