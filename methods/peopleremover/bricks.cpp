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

/// A voxel of a map.
struct Member {
  BrickId brick;
  int bit;
};

/// Removes a component from `left`, the freed voxels without a component.
class ComponentTaker {
 public:
  ComponentTaker(const BrickMap& map, std::vector<BrickWord>& left)
      : map_(map), finder_(map), left_(left) {}

  /// Removes all voxels that are connected with the lowest remaining voxel of `brick`.
  const std::vector<Member>& take(BrickId brick) {
    members_.clear();
    move(brick, left_[brick] & -left_[brick]);
    for (std::size_t next = 0; next < members_.size(); ++next) {
      const Member member = members_[next];
      const VoxelIndex voxel = voxel_of_bit(map_.index_of(member.brick), member.bit);
      for_each_brick_near(finder_, voxel, 1, [this](BrickId near, BrickWord voxels) {
        move(near, left_[near] & voxels);
      });
    }
    return members_;
  }

 private:
  void move(BrickId brick, BrickWord voxels) {
    left_[brick] &= ~voxels;
    for (; voxels != 0; voxels &= voxels - 1) members_.push_back({brick, std::countr_zero(voxels)});
  }

  const BrickMap& map_;
  BrickFinder finder_;
  std::vector<BrickWord>& left_;
  std::vector<Member> members_;
};

}  // namespace

const SlabMasks& slab_masks() {
  static const SlabMasks masks = make_slab_masks();
  return masks;
}

BrickMap::BrickMap(const CellSet& voxels) {
  std::vector<std::pair<VoxelKey, BrickWord>> bricks;
  voxels.for_each_brick([&](VoxelKey brick, BrickWord cells) {
    bricks.emplace_back(voxel_key(brick_of(voxel_index(cell_at(brick, 0)))), cells);
  });
  if (bricks.size() >= kNoBrick) {
    throw DataError("the map needs more than 4,294,967,294 bricks; use larger voxels.");
  }
  // Inside a block, keys run along x, then y, then z, as the bits of a block's words do.
  std::sort(bricks.begin(), bricks.end(), [](const auto& a, const auto& b) {
    return std::pair(block_key(a.first), a.first) < std::pair(block_key(b.first), b.first);
  });
  occupied_.reserve(bricks.size());
  keys_.reserve(bricks.size());
  VoxelKey current = ~VoxelKey{0};
  for (const auto& [brick, cells] : bricks) {
    const VoxelKey key = block_key(brick);
    if (key != current) {
      current = key;
      block_of_.insert({key, static_cast<std::uint32_t>(blocks_.size())});
      blocks_.emplace_back().first = static_cast<BrickId>(occupied_.size());
    }
    const BrickIndex at = voxel_index(brick);
    Block& block = blocks_.back();
    const auto word = static_cast<std::size_t>(at.z() & 7);
    block.present[word] |= std::uint64_t{1} << ((at.x() & 7) | ((at.y() & 7) << 3));
    for (std::size_t after = word + 1; after < 8; ++after) ++block.before[after];
    occupied_.push_back(cells);
    keys_.push_back(brick);
  }
}

void discard_small_clusters(const BrickMap& map, int minimum, std::vector<BrickWord>& freed) {
  if (minimum <= 1) return;
  std::vector<BrickWord> left = freed;
  ComponentTaker taker(map, left);
  for (BrickId brick = 0; brick < freed.size(); ++brick) {
    while (left[brick] != 0) {
      const std::vector<Member>& members = taker.take(brick);
      if (members.size() >= static_cast<std::size_t>(minimum)) continue;
      for (const Member& member : members) freed[member.brick] &= ~(BrickWord{1} << member.bit);
    }
  }
}

}  // namespace raymoval::peopleremover_method
