// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/verdicts.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"

namespace raymoval {
namespace {

constexpr int kBrick = 8;
constexpr int kMaximumRadius = 8;  // A brick's neighbours are all that is looked at.

/// Votes in a cube of cells around a brick.
class Ballot {
 public:
  explicit Ballot(int radius) : radius_(radius), side_(kBrick + 2 * radius) {
    const auto cells = static_cast<std::size_t>(side_ * side_ * side_);
    votes_.resize(cells);
    sums_.resize(cells);
  }
  void clear() { std::fill(votes_.begin(), votes_.end(), 0U); }
  /// Adds a vote at a cell relative to the brick's lower corner; ignored outside the cube.
  void add(const VoxelIndex& cell, std::uint32_t vote) {
    const VoxelIndex at = cell.array() + radius_;
    if ((at.array() < 0).any() || (at.array() >= side_).any()) return;
    votes_[offset(at.x(), at.y(), at.z())] = vote;
  }
  /// Sums the cube around each of the brick's cells, one axis after the other.
  void count() {
    sum_along(1, side_, side_);
    sum_along(side_, side_, side_);
    sum_along(side_ * side_, side_, side_);
  }
  [[nodiscard]] std::uint32_t around(const VoxelIndex& cell) const {
    return votes_[offset(cell.x() + radius_, cell.y() + radius_, cell.z() + radius_)];
  }

 private:
  [[nodiscard]] std::size_t offset(int x, int y, int z) const {
    return static_cast<std::size_t>((z * side_ + y) * side_ + x);
  }
  void sum_along(int step, int, int) {
    const int cells = side_ * side_ * side_;
    for (int i = 0; i < cells; ++i) {
      const int at = (i / step) % side_;
      if (at < radius_ || at >= side_ - radius_) continue;
      std::uint32_t sum = 0;
      for (int k = -radius_; k <= radius_; ++k) {
        sum += votes_[static_cast<std::size_t>(i + k * step)];
      }
      sums_[static_cast<std::size_t>(i)] = sum;
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

}  // namespace

void decide_voxels(EvidenceMap& map, const RaymovalPlusParameters& parameters) {
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double needed = parameters.free_constant + parameters.free_per_agree * map.agree_scans[i];
    const bool left = parameters.run_scans > 0 && (map.leading_free[i] >= parameters.run_scans ||
                                                   map.trailing_free[i] >= parameters.run_scans);
    if (left || map.free_scans[i] >= needed) {
      map.evidence[i] = Evidence::kDynamic;
    } else if (map.agree_scans[i] >= parameters.static_agree) {
      map.evidence[i] = Evidence::kStatic;
    } else {
      map.evidence[i] = Evidence::kUndecided;
    }
  }
}

void vote(EvidenceMap& map, const RaymovalPlusParameters& parameters, int threads) {
  if (parameters.vote_radius <= 0) return;
  const int radius = std::min(parameters.vote_radius, kMaximumRadius);
  std::vector<Evidence> elected(map.size());
  parallel_chunks(threads, map.brick_count(), 64, [&](std::size_t begin, std::size_t end) {
    Ballot ballot(radius);
    for (std::size_t b = begin; b < end; ++b) {
      const EvidenceMap::Brick& brick = map.brick(b);
      const VoxelIndex corner = brick.index * kBrick;
      ballot.clear();
      for (int n = 0; n < 27; ++n) {
        const VoxelIndex beside(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        const EvidenceMap::Brick* const other = map.brick_at(brick.index + beside);
        if (other == nullptr) continue;
        for (std::uint32_t v = other->first; v < other->last; ++v) {
          ballot.add(voxel_index(map.key(v)) - corner, vote_of(map.evidence[v]));
        }
      }
      ballot.count();
      for (std::uint32_t v = brick.first; v < brick.last; ++v) {
        const std::uint32_t votes = ballot.around(voxel_index(map.key(v)) - corner);
        const double decided = votes & 0xFFFFU, dynamic = votes >> 16U;
        elected[v] = decided == 0 ? Evidence::kUndecided
                     : dynamic >= (map.evidence[v] == Evidence::kDynamic ? parameters.vote_keep
                                                                         : parameters.vote_share) *
                                      decided
                         ? Evidence::kDynamic
                         : Evidence::kStatic;
      }
    }
  });
  map.evidence = std::move(elected);
}

}  // namespace raymoval
