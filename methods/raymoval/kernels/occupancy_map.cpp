// SPDX-License-Identifier: MIT
#include "methods/raymoval/kernels/occupancy_map.h"

#include "core/error.h"
#include "core/parallel.h"

namespace raymoval::raymoval_method {
namespace {

/// Room for boxes is given out in multiples of this.
constexpr std::size_t kBoxGrain = 4;

}  // namespace

OccupancyMap::Slot OccupancyMap::make_brick(const Eigen::Vector3i& brick) {
  const auto next = static_cast<Slot>(bricks_.size());
  const auto [found, is_new] = index_.try_emplace(voxel_key(brick), next);
  if (!is_new) return found->second;
  const Eigen::Vector2i tile = tile_of(brick);
  const auto next_tile = static_cast<std::uint32_t>(tiles_.size());
  const auto [tile_at, is_new_tile] =
      tile_index_.try_emplace(voxel_key(tile.x(), tile.y(), 0), next_tile);
  if (is_new_tile) tiles_.emplace_back();
  std::vector<BrickHead>& heads = tiles_[tile_at->second];
  bricks_.emplace_back();
  is_changed_.push_back(0);
  Cover& cover = covers_.emplace_back();
  cover.tile = tile_at->second;
  cover.head = static_cast<std::uint32_t>(heads.size());
  BrickHead& head = heads.emplace_back();
  head.at = {brick.x(), brick.y(), brick.z()};
  head.slot = next;
  return next;
}

bool OccupancyMap::erase(const VoxelIndex& voxel) {
  const Slot slot = find_slot(brick_of(voxel));
  if (slot == kNoBrick) return false;
  std::uint64_t& word = word_of(slot, voxel);
  const std::uint64_t bit = Brick::bit(voxel.y(), voxel.z());
  if ((word & bit) == 0) return false;
  word &= ~bit;
  --size_;
  mark_changed(slot, Change::kShrunk);
  return true;
}

bool OccupancyMap::contains_near(const VoxelIndex& voxel, int dilation) const {
  const VoxelIndex low = voxel.array() - dilation, high = voxel.array() + dilation;
  const Eigen::Vector3i first = brick_of(low), last = brick_of(high);
  for (int z = first.z(); z <= last.z(); ++z) {
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int x = first.x(); x <= last.x(); ++x) {
        const Brick* found = find_brick({x, y, z});
        if (found == nullptr) continue;
        const BrickPart part = BrickPart::within({x, y, z}, low, high);
        for (int word = part.first_word; word <= part.last_word; ++word) {
          if ((found->occupied[static_cast<std::size_t>(word)] & part.mask) != 0) return true;
        }
      }
    }
  }
  return false;
}

void OccupancyMap::update_boxes(int threads) {
  if (changed_.empty()) return;  // Nothing is written: several threads may read the map.
  constexpr std::size_t kGrain = 32;
  // Covers are found in parallel and stored in the order of change: the same for any threads.
  struct Part {
    std::vector<BrickBox> boxes;
    std::vector<std::size_t> ends;
    std::vector<bool> is_fresh;
  };
  std::vector<Part> parts((changed_.size() + kGrain - 1) / kGrain);
  parallel_chunks(threads, changed_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Part& part = parts[begin / kGrain];
    std::vector<BrickBox> cover;
    for (std::size_t i = begin; i < end; ++i) {
      part.is_fresh.push_back(cover_again(changed_[i], cover));
      part.boxes.insert(part.boxes.end(), cover.begin(), cover.end());
      part.ends.push_back(part.boxes.size());
    }
  });
  for (std::size_t i = 0; i < changed_.size(); ++i) {
    const Part& part = parts[i / kGrain];
    const std::size_t begin = i % kGrain == 0 ? 0 : part.ends[i % kGrain - 1];
    store_boxes(changed_[i], part.boxes.data() + begin, part.ends[i % kGrain] - begin);
    if (part.is_fresh[i % kGrain]) covers_[changed_[i]].fresh_count = covers_[changed_[i]].count;
    is_changed_[changed_[i]] = 0;
  }
  changed_.clear();
}

bool OccupancyMap::cover_again(Slot slot, std::vector<BrickBox>& boxes) const {
  const auto present = this->boxes(slot);
  boxes.assign(present.begin(), present.end());
  mend_cover(bricks_[slot], is_changed_[slot] == 2 ? Change::kShrunk : Change::kGrown, boxes);
  // A mended cover gets worse with time.
  if (boxes.size() <= covers_[slot].fresh_count * 3U / 2U + 2U) return false;
  cover_with_boxes(bricks_[slot], boxes);
  return true;
}

void OccupancyMap::store_boxes(Slot slot, const BrickBox* boxes, std::size_t count) {
  Cover& cover = covers_[slot];
  BrickHead& head = tiles_[cover.tile][cover.head];
  head.is_empty = count == 0;
  if (count > 0) head.bounds = tight_box(bricks_[slot]);
  if (count > cover.capacity) {
    const std::size_t size_class = (count + kBoxGrain - 1) / kBoxGrain;
    if (free_boxes_.size() <= size_class) free_boxes_.resize(size_class + 1);
    if (cover.capacity > 0) free_boxes_[cover.capacity / kBoxGrain].push_back(cover.begin);
    cover.capacity = static_cast<std::uint16_t>(size_class * kBoxGrain);
    if (free_boxes_[size_class].empty()) {
      cover.begin = static_cast<std::uint32_t>(boxes_.size());
      boxes_.resize(boxes_.size() + cover.capacity);
    } else {
      cover.begin = free_boxes_[size_class].back();
      free_boxes_[size_class].pop_back();
    }
  }
  std::copy_n(boxes, count, boxes_.begin() + cover.begin);
  cover.count = static_cast<std::uint16_t>(count);
}

std::size_t OccupancyMap::memory_bytes() const {
  const auto held = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
  constexpr std::size_t kBucket = 24;  // Of the hash grids: key, value and their book-keeping.
  std::size_t bytes = held(bricks_) + held(covers_) + held(is_changed_) + held(changed_) +
                      held(tiles_) + held(boxes_) + held(free_boxes_);
  for (const auto& tile : tiles_) bytes += held(tile);
  for (const auto& list : free_boxes_) bytes += held(list);
  return bytes + (index_.bucket_count() + tile_index_.bucket_count()) * kBucket;
}

}  // namespace raymoval::raymoval_method
