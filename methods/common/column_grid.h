// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/scan/voxel_key.h"
#include "core/text.h"

namespace raymoval {
namespace column_blocks {

/// Voxels come in blocks of 32 x 32 upright columns of 64. A word holds a column: the beams of a
/// LiDAR run mostly level, so that neighbours on a beam lie in different words and marking one does
/// not wait for the other.
inline constexpr int kSideBits = 5;
inline constexpr int kSide = 1 << kSideBits;
inline constexpr int kHeightBits = 6;
inline constexpr int kHeight = 1 << kHeightBits;
inline constexpr int kColumns = kSide * kSide;

/// Block of a voxel: its indices divided by the block's sides, rounded down.
inline VoxelIndex block_of(const VoxelIndex& voxel) {
  return {voxel.x() >> kSideBits, voxel.y() >> kSideBits, voxel.z() >> kHeightBits};
}
/// The number of a column in its block, from its indices in it.
constexpr std::size_t column_at(int x, int y) {
  return static_cast<std::size_t>(x * kSide + y);
}
/// Column of a voxel in its block.
inline std::size_t column_of(const VoxelIndex& voxel) {
  return column_at(voxel.x() & (kSide - 1), voxel.y() & (kSide - 1));
}
/// Bit of a voxel in its column.
inline std::uint64_t bit_of(const VoxelIndex& voxel) {
  return std::uint64_t{1} << (voxel.z() & (kHeight - 1));
}
/// The voxel of a bit of a column of a block.
inline VoxelIndex voxel_at(const VoxelIndex& block, std::size_t column, int height) {
  const int place = static_cast<int>(column);
  return {block.x() * kSide + place / kSide, block.y() * kSide + place % kSide,
          block.z() * kHeight + height};
}

}  // namespace column_blocks

/// A block of a `ColumnGrid`.
template <class Column>
struct ColumnBlock {
  VoxelIndex at = VoxelIndex::Zero();  ///< Block indices (see `block_of`).
  /// The neighbours below and above along x, y and z, or null where nobody asked for them.
  std::array<std::array<ColumnBlock*, 2>, 3> beside{};
  std::array<Column, column_blocks::kColumns> columns{};
};

/// What one scan says of voxels, in sparse blocks. `Column` holds words with a bit for each voxel
/// of a column, the lowest voxel the lowest bit. `clear` keeps the memory for the next scan.
template <class Column>
class ColumnGrid {
 public:
  using Block = ColumnBlock<Column>;

  /// The largest number of blocks (8 KiB for each word of a column). No scan of a real place needs
  /// as many.
  static constexpr std::size_t kMostBlocks = std::size_t{1} << 18;

  /// @param method whose name the error names
  /// @param remedy a sentence that says what to do about the error
  ColumnGrid(std::string method, std::string remedy)
      : method_(std::move(method)), remedy_(std::move(remedy)) {}

  /// The block at these block indices. It is made if there is none yet. References stay valid until
  /// `clear`. @throws DataError beyond `kMostBlocks`.
  Block& block(const VoxelIndex& at) {
    if (last_ != nullptr && last_->at == at) return *last_;
    const VoxelKey key = voxel_key(at);
    const auto found = index_.find(key);
    last_ = found != index_.end() ? blocks_[found->second].get() : &add_block(at, key);
    return *last_;
  }
  /// The neighbour of a block along an axis; `step` is +1 or -1. It is made if there is none yet.
  Block& beside(Block& from, Eigen::Index axis, int step) {
    Block*& link = from.beside[static_cast<std::size_t>(axis)][step > 0 ? 1 : 0];
    if (link == nullptr) {
      VoxelIndex at = from.at;
      at[axis] += step;
      link = &block(at);
    }
    return *link;
  }
  /// The block at these block indices, or null.
  [[nodiscard]] const Block* find(const VoxelIndex& at) const {
    const auto found = index_.find(voxel_key(at));
    return found == index_.end() ? nullptr : blocks_[found->second].get();
  }
  Column& column(const VoxelIndex& voxel) {
    return block(column_blocks::block_of(voxel)).columns[column_blocks::column_of(voxel)];
  }

  [[nodiscard]] std::size_t size() const { return used_; }
  [[nodiscard]] const Block& operator[](std::size_t i) const { return *blocks_[i]; }
  [[nodiscard]] Block& operator[](std::size_t i) { return *blocks_[i]; }
  void clear() {
    index_.clear();
    used_ = 0;
    last_ = nullptr;
  }

 private:
  Block& add_block(const VoxelIndex& at, VoxelKey key) {
    if (used_ >= kMostBlocks) {
      throw DataError(method_ + ": the beams of one scan cross more than " +
                      grouped_text(kMostBlocks * column_blocks::kColumns * column_blocks::kHeight) +
                      " voxels; expected points within reach of a LiDAR. " + remedy_);
    }
    index_.emplace(key, static_cast<std::uint32_t>(used_));
    if (used_ == blocks_.size()) blocks_.push_back(std::make_unique<Block>());
    Block& block = *blocks_[used_++];
    block.at = at;
    block.beside = {};
    block.columns.fill(Column{});
    return block;
  }

  std::string method_, remedy_;
  VoxelMap<std::uint32_t> index_;
  std::vector<std::unique_ptr<Block>> blocks_;  ///< The first `used_` are this scan's.
  std::size_t used_ = 0;
  Block* last_ = nullptr;  ///< The block that was asked for last, which is mostly asked for again.
};

}  // namespace raymoval
