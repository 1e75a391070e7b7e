// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval::raymoval_method {

/// Voxels of one brick of 8 x 8 x 8: word = x, byte of the word = y, bit of the byte = z.
struct Brick {
  static constexpr int kBits = 3;
  static constexpr int kSide = 1 << kBits;
  static constexpr int kMask = kSide - 1;

  std::array<std::uint64_t, kSide> occupied{};

  /// Coordinates may be relative to the brick or those of the world's lattice.
  [[nodiscard]] bool contains(int x, int y, int z) const {
    return (occupied[static_cast<std::size_t>(x & kMask)] & bit(y, z)) != 0;
  }
  void add(int x, int y, int z) { occupied[static_cast<std::size_t>(x & kMask)] |= bit(y, z); }
  static std::uint64_t bit(int y, int z) {
    return std::uint64_t{1} << ((y & kMask) * kSide + (z & kMask));
  }
};

/// Box of voxels within a brick in 18 bits: first and last voxel (inclusive), 3 bits per axis.
struct BrickBox {
  std::uint32_t packed = 0;

  static BrickBox from(const std::array<int, 3>& first, const std::array<int, 3>& last) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits |= static_cast<std::uint32_t>(first[k]) << (3 * k);
      bits |= static_cast<std::uint32_t>(last[k]) << (9 + 3 * k);
    }
    return {bits};
  }
  [[nodiscard]] int first(std::size_t axis) const {
    return static_cast<int>(packed >> (3 * axis) & 7U);
  }
  [[nodiscard]] int last(std::size_t axis) const {
    return static_cast<int>(packed >> (9 + 3 * axis) & 7U);
  }
};

/// Boxes that together hold each occupied voxel of `brick` and no empty one; they may overlap. The
/// first hit of a ray is the same for boxes and voxels, and there are about five times fewer boxes.
/// Greedy: the lowest voxel without a box and the run of voxels above and below it are grown over
/// occupied voxels in either order of axes. The box that covers more uncovered voxels is kept.
/// @param boxes replaced
void cover_with_boxes(const Brick& brick, std::vector<BrickBox>& boxes);

/// The smallest box with all occupied voxels of a brick, which must not be empty.
BrickBox tight_box(const Brick& brick);

/// Voxels of a brick that are within a box of the lattice.
struct BrickPart {
  int first_word, last_word;
  std::uint64_t mask;  ///< The voxels of the box in each of these words.

  /// @param brick brick coordinates; the box `low` .. `high` (inclusive) reaches into it
  static BrickPart within(const Eigen::Vector3i& brick, const VoxelIndex& low,
                          const VoxelIndex& high) {
    const Eigen::Vector3i from = (low - brick * Brick::kSide).cwiseMax(0);
    const Eigen::Vector3i to = (high - brick * Brick::kSide).cwiseMin(Brick::kMask);
    const auto ones = [](int count) { return ~std::uint64_t{0} >> (64 - count); };
    const std::uint64_t column = ones(to.z() - from.z() + 1) << from.z();
    const std::uint64_t rows = ones(Brick::kSide * (to.y() - from.y() + 1))
                               << (Brick::kSide * from.y());
    return {from.x(), to.x(), (0x0101010101010101ULL * column) & rows};
  }
};

/// Occupied voxels in sparse bricks of 8 x 8 x 8, one bit each. Insert, erase and look-up take
/// constant time; memory grows with the occupied part only.
///
/// For the raycasting each brick also keeps boxes that cover its voxels, and each tile of 8 x 8
/// bricks seen from above has a list of its bricks. `update_boxes` rebuilds the boxes of changed
/// bricks, at a cost that depends on the changes and not on the map.
class OccupancyMap {
 public:
  static constexpr int kBrickBits = Brick::kBits;
  static constexpr int kBrickSide = Brick::kSide;
  static constexpr int kTileBits = 3;  ///< A tile is 8 x 8 bricks.
  using Slot = std::uint32_t;          ///< Number of a brick, in order of creation.
  static constexpr Slot kNoBrick = ~Slot{0};

  /// The data of a brick that the raycasting reads first.
  struct BrickHead {
    std::array<std::int32_t, 3> at{};  ///< Brick coordinates: voxel coordinates / 8, rounded down.
    Slot slot = 0;
    BrickBox bounds;       ///< Tight box of its voxels.
    bool is_empty = true;  ///< It has no voxel.
  };

  explicit OccupancyMap(double voxel_size)
      : voxel_size_(voxel_size), inverse_voxel_size_(1.0 / voxel_size) {}

  [[nodiscard]] double voxel_size() const { return voxel_size_; }
  [[nodiscard]] double inverse_voxel_size() const { return inverse_voxel_size_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t brick_count() const { return bricks_.size(); }
  /// Voxel of a world point in metres.
  [[nodiscard]] VoxelIndex voxel_of(const Eigen::Vector3d& world) const {
    return voxel_index(world, inverse_voxel_size_);
  }

  /// Adds a voxel. @return whether it was empty
  bool insert(const VoxelIndex& voxel) { return insert(make_brick(brick_of(voxel)), voxel); }
  /// The same for a voxel of the brick `slot`.
  bool insert(Slot slot, const VoxelIndex& voxel) {
    std::uint64_t& word = word_of(slot, voxel);
    const std::uint64_t bit = Brick::bit(voxel.y(), voxel.z());
    if ((word & bit) != 0) return false;
    mark_changed(slot);
    word |= bit;
    ++size_;
    return true;
  }
  /// Removes a voxel. @return whether it was occupied
  bool erase(const VoxelIndex& voxel);
  [[nodiscard]] bool contains(const VoxelIndex& voxel) const {
    const Brick* brick = find_brick(brick_of(voxel));
    return brick != nullptr && brick->contains(voxel.x(), voxel.y(), voxel.z());
  }
  /// True if any voxel within `dilation` cells (Chebyshev) is occupied.
  [[nodiscard]] bool contains_near(const VoxelIndex& voxel, int dilation) const;

  [[nodiscard]] static Eigen::Vector3i brick_of(const VoxelIndex& voxel) {
    return {voxel.x() >> kBrickBits, voxel.y() >> kBrickBits, voxel.z() >> kBrickBits};
  }
  /// The brick with these brick coordinates, or null.
  [[nodiscard]] const Brick* find_brick(const Eigen::Vector3i& brick) const {
    const Slot slot = find_slot(brick);
    return slot == kNoBrick ? nullptr : &bricks_[slot];
  }
  [[nodiscard]] Slot find_slot(const Eigen::Vector3i& brick) const {
    const auto found = index_.find(voxel_key(brick));
    return found == index_.end() ? kNoBrick : found->second;
  }
  /// The number of a brick, which is made if it is missing.
  Slot make_brick(const Eigen::Vector3i& brick);
  [[nodiscard]] const Brick& brick(Slot slot) const { return bricks_[slot]; }

  /// Updates boxes and heads of the bricks changed since the last call; writes nothing if there are
  /// none.
  void update_boxes(int threads);
  /// Boxes that cover the brick's voxels, as of the last `update_boxes`.
  [[nodiscard]] std::span<const BrickBox> boxes(Slot slot) const { return boxes_[slot]; }

  [[nodiscard]] static Eigen::Vector2i tile_of(const Eigen::Vector3i& brick) {
    return {brick.x() >> kTileBits, brick.y() >> kTileBits};
  }
  [[nodiscard]] std::size_t tile_count() const { return tiles_.size(); }
  /// Heads of the tile's bricks; empty where there is no tile.
  [[nodiscard]] std::span<const BrickHead> tile(int x, int y) const {
    const auto found = tile_index_.find(voxel_key(x, y, 0));
    return found == tile_index_.end() ? std::span<const BrickHead>() : tiles_[found->second];
  }
  [[nodiscard]] std::span<const BrickHead> tile(std::size_t number) const { return tiles_[number]; }

 private:
  struct Place {
    std::uint32_t tile = 0, head = 0;  ///< Of the brick's head.
    bool is_changed = false;           ///< It is in `changed_`.
  };

  std::uint64_t& word_of(Slot slot, const VoxelIndex& voxel) {
    return bricks_[slot].occupied[static_cast<std::size_t>(voxel.x() & Brick::kMask)];
  }
  void mark_changed(Slot slot) {
    if (!places_[slot].is_changed) changed_.push_back(slot);
    places_[slot].is_changed = true;
  }

  double voxel_size_;
  double inverse_voxel_size_;
  std::size_t size_ = 0;
  VoxelMap<Slot> index_;
  std::vector<Brick> bricks_;
  std::vector<Place> places_;                 ///< Of each brick.
  std::vector<std::vector<BrickBox>> boxes_;  ///< Of each brick.
  std::vector<Slot> changed_;                 ///< Bricks, in the order of their first change.
  VoxelMap<std::uint32_t> tile_index_;
  std::vector<std::vector<BrickHead>> tiles_;
};

}  // namespace raymoval::raymoval_method
