// SPDX-License-Identifier: MIT
#include "methods/peopleremover/bricks.h"

#include <tuple>
#include <utility>

#include "core/error.h"

namespace raymoval::peopleremover_method {
namespace {

VoxelKey block_key(VoxelKey brick) {
  const BrickIndex index = voxel_index(brick);
  return voxel_key(index.x() >> kBlockBits, index.y() >> kBlockBits, index.z() >> kBlockBits);
}

SlabMasks make_slab_masks() {
  SlabMasks masks{};
  for (int bit = 0; bit < 64; ++bit) {
    const std::array<int, 3> local = {bit & 3, (bit >> 2) & 3, bit >> 4};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (int low = 0; low <= local[axis]; ++low) {
        for (int high = local[axis]; high < kBrickSide; ++high) {
          masks.of[axis][static_cast<std::size_t>(low)][static_cast<std::size_t>(high)] |=
              BrickWord{1} << bit;
        }
      }
    }
  }
  return masks;
}

}  // namespace

const SlabMasks& slab_masks() {
  static const SlabMasks masks = make_slab_masks();
  return masks;
}

BrickMap::BrickMap(std::vector<BrickVoxels> bricks) {
  if (bricks.size() >= kNoBrick) {
    throw DataError("the map needs more than 4,294,967,294 bricks; use larger voxels.");
  }
  // Inside a block, keys run along x, then y, then z, as the bits of a block's words do.
  std::sort(bricks.begin(), bricks.end(), [](const BrickVoxels& a, const BrickVoxels& b) {
    return std::pair(block_key(a.brick), a.brick) < std::pair(block_key(b.brick), b.brick);
  });
  occupied_.reserve(bricks.size());
  keys_.reserve(bricks.size());
  VoxelKey current = ~VoxelKey{0};
  for (const BrickVoxels& brick : bricks) {
    const VoxelKey key = block_key(brick.brick);
    if (key != current) {
      current = key;
      block_of_.insert({key, static_cast<std::uint32_t>(blocks_.size())});
      blocks_.emplace_back().first = static_cast<BrickId>(occupied_.size());
    }
    const BrickIndex at = voxel_index(brick.brick);
    Block& block = blocks_.back();
    const auto word = static_cast<std::size_t>(at.z() & 7);
    block.present[word] |= std::uint64_t{1} << ((at.x() & 7) | ((at.y() & 7) << 3));
    for (std::size_t after = word + 1; after < 8; ++after) ++block.before[after];
    occupied_.push_back(brick.voxels);
    keys_.push_back(brick.brick);
  }
}

void BrickCollector::add(const VoxelMap<BrickWord>& bricks) {
  const std::lock_guard lock(mutex_);
  for (const auto& [brick, voxels] : bricks) bricks_[brick] |= voxels;
}

BrickMap BrickCollector::take() {
  const std::lock_guard lock(mutex_);
  std::vector<BrickVoxels> list;
  list.reserve(bricks_.size());
  for (const auto& [brick, voxels] : bricks_) list.push_back({brick, voxels});
  bricks_ = {};
  return BrickMap(std::move(list));
}

}  // namespace raymoval::peopleremover_method
