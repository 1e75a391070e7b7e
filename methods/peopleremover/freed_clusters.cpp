// SPDX-License-Identifier: MIT
#include "methods/peopleremover/freed_clusters.h"

namespace raymoval::peopleremover_method {
namespace {

/// A voxel of a map.
struct Member {
  BrickId brick;
  int bit;
};

/// Takes a component out of `left`, the freed voxels that are in none yet.
class ComponentTaker {
 public:
  ComponentTaker(const BrickMap& map, std::vector<BrickWord>& left)
      : map_(map), finder_(map), left_(left) {}

  /// Takes all voxels that are connected with the lowest one left in `brick`.
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
