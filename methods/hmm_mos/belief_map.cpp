// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/belief_map.h"

#include <algorithm>
#include <bit>

#include "core/parallel.h"

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
          "hmm_mos.spread and hmm_mos.transition: distances too far away would count; expected a "
          "smaller spread, or a larger transition.");
    }
  }
}

bool BeliefModel::is_far(double likelihood) const {
  // In the worst case, occupied has its largest prior probability. The result decreases with the
  // distance.
  const double stays = likelihood * (1.0 - transition_), goes = (1.0 - likelihood) * transition_;
  const double occupied = stays / (stays + goes);
  return 1.0 - occupied == 1.0 && transition_ + keep_ * occupied == transition_;
}

BeliefMap::BeliefMap(const Parameters& parameters)
    : lattice_(parameters),
      model_(parameters),
      range_(parameters.max_range * parameters.map_range_factor),
      scans_(parameters.map_scans),
      offline_(parameters.offline),
      distances_([far = model_.far()] { return std::make_unique<DistanceField>(far); }) {}

void BeliefMap::observe(const ScanVoxels& now_voxels, const ScanVoxels& before,
                        const RunContext& context) {
  const ScanGrid& now = now_voxels.grid;
  ++now_;
  find_beyond(now_voxels, before, beyond_);
  std::vector<Block*> blocks;
  for (std::size_t i = 0; i < now.size(); ++i) {
    blocks.push_back(&blocks_.find_or_make(now[i].at, now[i].at));
  }
  parallel_for(context.threads, blocks.size(), 1, [&](std::size_t i) {
    context.check_cancelled();
    distances_.with_one([&](DistanceField& distances) {
      distances.find(now, before.grid, beyond_, now[i]);
      observe_block(now[i], distances, *blocks[i]);
    });
  });
  appeared_.clear();
  for (const Block* block : blocks) {
    appeared_.insert(appeared_.end(), block->appeared.begin(), block->appeared.end());
  }
}

std::size_t BeliefMap::brick_of(std::size_t column, int height) {
  const std::size_t x = column / kSide, y = column % kSide, z = static_cast<std::size_t>(height);
  return (x >> kBrickBits) << 5 | (y >> kBrickBits) << 3 | z >> kBrickBits;
}

std::size_t BeliefMap::place_of(std::size_t column, int height) {
  const std::size_t x = column / kSide, y = column % kSide, z = static_cast<std::size_t>(height);
  constexpr std::size_t kLow = kBrickSide - 1;
  return (x & kLow) << 6 | (y & kLow) << 3 | (z & kLow);
}

void BeliefMap::observe_block(const ScanBlock& seen, const DistanceField& distances,
                              Block& block) const {
  block.appeared.clear();
  for (std::size_t column = 0; column < kColumns; ++column) {
    const Column& here = seen.columns[column];
    for (std::uint64_t left = here.hit & block.known[column] & block.free[column]; left != 0;
         left &= left - 1) {
      block.appeared.push_back(voxel_at(block.at, column, std::countr_zero(left)));
    }
    for (std::uint64_t left = here.free; left != 0; left &= left - 1) {
      const int height = std::countr_zero(left);
      observe_voxel(column, height, distances.at(column, height), block);
    }
  }
}

void BeliefMap::observe_voxel(std::size_t column, int height, int distance, Block& block) const {
  std::unique_ptr<Brick>& brick = block.bricks[brick_of(column, height)];
  if (brick == nullptr) brick = std::make_unique<Brick>();
  const std::size_t place = place_of(column, height);
  double& occupied = brick->occupied[place];
  occupied = model_.after(occupied, distance);
  brick->seen[place] = now_;
  brick->oldest = std::min(brick->oldest, now_);
  brick->newest = now_;
  const std::uint64_t bit = std::uint64_t{1} << height;
  if (model_.is_free(occupied)) {
    block.known[column] |= bit;
    block.free[column] |= bit;
  } else if (model_.is_occupied(occupied)) {
    block.known[column] |= bit;
    block.free[column] &= ~bit;
  }
}

void BeliefMap::forget(const Eigen::Vector3d& sensor) {
  const ScanNumber last = now_ > static_cast<ScanNumber>(scans_) ? now_ - scans_ : 0;
  blocks_.erase_if([&](Block& block) {
    const VoxelIndex origin = block.at.cwiseProduct(VoxelIndex(kSide, kSide, kHeight));
    bool is_empty = true;
    for (std::size_t number = 0; number < kBricks; ++number) {
      std::unique_ptr<Brick>& brick = block.bricks[number];
      if (brick == nullptr) continue;
      const bool is_near = is_within(origin + corner_of(number), sensor);
      if (!is_near || brick->oldest < last) {
        forget_voxels(block, number, [&](ScanNumber seen, const VoxelIndex& place) {
          return seen < last ||
                 (!is_near && (lattice_.position(origin + place) - sensor).norm() > range_);
        });
        if (brick->newest == 0) brick.reset();
      }
      is_empty &= brick == nullptr;
    }
    return is_empty;
  });
}

/// Whether the whole brick is so near to the sensor that none of its voxels is forgotten.
bool BeliefMap::is_within(const VoxelIndex& first, const Eigen::Vector3d& sensor) const {
  const Eigen::Vector3d low = lattice_.position(first) - sensor;
  const Eigen::Vector3d high = low.array() + kBrickSide * lattice_.size();
  return low.cwiseAbs().cwiseMax(high.cwiseAbs()).norm() < range_;
}

/// The position of a brick's lowest voxel in its block.
VoxelIndex BeliefMap::corner_of(std::size_t brick) {
  const auto at = static_cast<int>(brick);
  return VoxelIndex(at >> 5, at >> 3 & 3, at & 7) * kBrickSide;
}

/// Forgets the voxels of a brick for which `is_gone(seen, place in the block)`.
template <class IsGone>
void BeliefMap::forget_voxels(Block& block, std::size_t number, IsGone&& is_gone) {
  Brick& brick = *block.bricks[number];
  const VoxelIndex corner = corner_of(number);
  brick.oldest = std::numeric_limits<ScanNumber>::max();
  brick.newest = 0;
  for (std::size_t i = 0; i < kBrickVoxels; ++i) {
    const ScanNumber seen = brick.seen[i];
    if (seen == 0) continue;
    const auto k = static_cast<int>(i);
    const VoxelIndex place = corner + VoxelIndex(k >> 6, k >> 3 & 7, k & 7);
    if (is_gone(seen, place)) {
      forget_voxel(block, brick, place);
      continue;
    }
    brick.oldest = std::min(brick.oldest, seen);
    brick.newest = std::max(brick.newest, seen);
  }
}

/// @param place in the block
void BeliefMap::forget_voxel(Block& block, Brick& brick, const VoxelIndex& place) {
  const std::size_t column = column_of(place);
  const std::size_t i = place_of(column, place.z());
  brick.seen[i] = 0;
  brick.occupied[i] = BeliefModel::kUnobserved;
  if (offline_ && (block.known[column] & bit_of(place)) != 0) {
    const VoxelKey voxel = voxel_key(voxel_at(block.at, column, place.z()));
    if ((block.free[column] & bit_of(place)) != 0) {
      forgotten_free_.insert(voxel);
    } else {
      forgotten_free_.erase(voxel);
    }
  }
  block.known[column] &= ~bit_of(place);
}

void BeliefMap::forget_all() {
  blocks_.erase_if([this](Block& block) {
    for (std::size_t number = 0; number < kBricks; ++number) {
      if (block.bricks[number] == nullptr) continue;
      forget_voxels(block, number, [](ScanNumber, const VoxelIndex&) { return true; });
    }
    return true;
  });
}

std::size_t BeliefMap::size() const {
  std::ptrdiff_t voxels = 0;
  blocks_.for_each([&](const Block& block) {
    for (const std::unique_ptr<Brick>& brick : block.bricks) {
      if (brick == nullptr) continue;
      voxels += kBrickVoxels - std::count(brick->seen.begin(), brick->seen.end(), 0U);
    }
  });
  return static_cast<std::size_t>(voxels);
}

}  // namespace raymoval::hmm_mos_method
