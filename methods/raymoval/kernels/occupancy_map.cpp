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
  changes_.push_back(Change::kNone);
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
  mark_changed(slot, Change::kShrunk);
  word &= ~bit;
  --size_;
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
  // Covers are found in parallel and stored in the order of change: the same for any threads. So
  // many bricks at a time, that what is held meanwhile does not grow with the map.
  constexpr std::size_t kGrain = 32, kBatch = 256 * kGrain;
  for (std::size_t first = 0; first < changed_.size(); first += kBatch) {
    const auto batch =
        std::span(changed_).subspan(first, std::min(kBatch, changed_.size() - first));
    std::vector<NewBoxes> new_boxes((batch.size() + kGrain - 1) / kGrain);
    parallel_chunks(threads, batch.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      find_boxes(batch.subspan(begin, end - begin), new_boxes[begin / kGrain]);
    });
    for (std::size_t begin = 0; begin < batch.size(); begin += kGrain) {
      store_boxes(batch.subspan(begin, std::min(kGrain, batch.size() - begin)),
                  new_boxes[begin / kGrain]);
    }
  }
  changed_.clear();
  before_.clear();
}

void OccupancyMap::find_boxes(std::span<const ChangedBrick> changed, NewBoxes& found) const {
  found.boxes.reserve(4 * changed.size());
  found.ends.reserve(changed.size());
  found.kinds.reserve(changed.size());
  for (const ChangedBrick& brick : changed) {
    found.kinds.push_back(cover_again(brick, found));
    found.ends.push_back(found.boxes.size());
  }
}

/// Appends the new boxes of a changed brick to `found.boxes`.
OccupancyMap::NewBoxes::Kind OccupancyMap::cover_again(const ChangedBrick& changed,
                                                       NewBoxes& found) const {
  const Brick& brick = bricks_[changed.slot];
  const auto present = this->boxes(changed.slot);
  // A mended cover gets worse with time.
  const std::size_t most = covers_[changed.slot].fresh_count * 3U / 2U + 2U;
  const std::size_t begin = found.boxes.size();
  if (!present.empty() && changes_[changed.slot] == Change::kGrown) {
    Brick added;
    for (std::size_t x = 0; x < added.occupied.size(); ++x) {
      added.occupied[x] = brick.occupied[x] & ~before_[changed.before].occupied[x];
    }
    cover_added(brick, added, found.boxes);
    if (present.size() + found.boxes.size() - begin <= most) return NewBoxes::Kind::kAdded;
    found.boxes.resize(begin);
  } else if (!present.empty()) {
    found.cover.assign(present.begin(), present.end());
    mend_cover(brick, found.cover);
    if (found.cover.size() <= most) {
      found.boxes.insert(found.boxes.end(), found.cover.begin(), found.cover.end());
      return NewBoxes::Kind::kMended;
    }
  }
  cover_with_boxes(brick, found.cover);
  found.boxes.insert(found.boxes.end(), found.cover.begin(), found.cover.end());
  return NewBoxes::Kind::kFresh;
}

void OccupancyMap::store_boxes(std::span<const ChangedBrick> changed, const NewBoxes& found) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const Slot slot = changed[i].slot;
    const std::size_t kept =
        found.kinds[i] == NewBoxes::Kind::kAdded ? covers_[slot].count : std::size_t{0};
    store_boxes(slot, kept, std::span(found.boxes).subspan(begin, found.ends[i] - begin));
    if (found.kinds[i] == NewBoxes::Kind::kFresh) covers_[slot].fresh_count = covers_[slot].count;
    changes_[slot] = Change::kNone;
    begin = found.ends[i];
  }
}

void OccupancyMap::store_boxes(Slot slot, std::size_t kept, std::span<const BrickBox> boxes) {
  Cover& cover = covers_[slot];
  BrickHead& head = tiles_[cover.tile][cover.head];
  const std::size_t count = kept + boxes.size();
  head.is_empty = count == 0;
  if (count > 0) head.bounds = tight_box(bricks_[slot]);
  if (count > cover.capacity) {
    const std::uint32_t before = cover.begin;
    const std::size_t size_class = (count + kBoxGrain - 1) / kBoxGrain;
    if (free_boxes_.size() <= size_class) free_boxes_.resize(size_class + 1);
    if (cover.capacity > 0) free_boxes_[cover.capacity / kBoxGrain].push_back(before);
    cover.capacity = static_cast<std::uint16_t>(size_class * kBoxGrain);
    if (free_boxes_[size_class].empty()) {
      cover.begin = static_cast<std::uint32_t>(boxes_.size());
      boxes_.resize(boxes_.size() + cover.capacity);
    } else {
      cover.begin = free_boxes_[size_class].back();
      free_boxes_[size_class].pop_back();
    }
    std::copy_n(boxes_.begin() + before, kept, boxes_.begin() + cover.begin);
  }
  std::copy(boxes.begin(), boxes.end(),
            boxes_.begin() + cover.begin + static_cast<std::ptrdiff_t>(kept));
  cover.count = static_cast<std::uint16_t>(count);
}

std::size_t OccupancyMap::memory_bytes() const {
  const auto held = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
  constexpr std::size_t kBucket = 24;  // Of the hash grids: key, value and their book-keeping.
  std::size_t bytes = held(bricks_) + held(covers_) + held(changes_) + held(changed_) +
                      held(before_) + held(tiles_) + held(boxes_) + held(free_boxes_);
  for (const auto& tile : tiles_) bytes += held(tile);
  for (const auto& list : free_boxes_) bytes += held(list);
  return bytes + (index_.bucket_count() + tile_index_.bucket_count()) * kBucket;
}

}  // namespace raymoval::raymoval_method
