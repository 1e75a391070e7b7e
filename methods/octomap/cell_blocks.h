// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/voxel_key.h"

namespace raymoval::octomap_method {

/// Morton code of a leaf of a tree of depth 16: the bits of the three 16-bit keys interleaved, x
/// lowest. Its highest three bits are the root's child, its lowest three the leaf among its
/// siblings, numbered as liboctomap numbers children.
using CellCode = std::uint64_t;

inline constexpr CellCode kAxisBits =
    0x249249249249;  ///< Bits of x; of y and z shifted by 1 and 2.

/// The 16 bits of `key`, two zero bits above each.
constexpr CellCode spread_bits(std::uint16_t key) {
  CellCode bits = key;
  bits = (bits | bits << 16) & 0x0000000000FF0000FF;
  bits = (bits | bits << 8) & 0x000000F00F00F00F;
  bits = (bits | bits << 4) & 0x00000C30C30C30C3;
  return (bits | bits << 2) & kAxisBits;
}

/// Every third bit of `code`, packed: what `spread_bits` spread.
constexpr std::uint16_t gather_bits(CellCode code) {
  code &= kAxisBits;
  code = (code | code >> 2) & 0x00000C30C30C30C3;
  code = (code | code >> 4) & 0x000000F00F00F00F;
  code = (code | code >> 8) & 0x0000000000FF0000FF;
  return static_cast<std::uint16_t>(code | code >> 16);
}

constexpr CellCode cell_code(std::uint16_t x, std::uint16_t y, std::uint16_t z) {
  return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

/// The 8 x 8 x 8 cells below one node of depth 13, a bit each in Morton order: a word is a child of
/// that node, a byte a grandchild, a bit a leaf.
struct CellBlock {
  std::array<std::uint64_t, 8> free{};
  std::array<std::uint64_t, 8> occupied{};
};

inline constexpr int kBlockBits = 9;  ///< Bits of a code that name the cell within its block.

/// Free and occupied cells of (a part of) a scan, block by block.
class CellBlocks {
 public:
  /// The block of all codes that begin with `block` (code >> kBlockBits). It is made if there is
  /// none. The reference holds until the next call.
  CellBlock& block(std::uint64_t block) {
    const auto [found, is_new] =
        numbers_.try_emplace(block, static_cast<std::uint32_t>(blocks_.size()));
    if (is_new) {
      names_.push_back(block);
      blocks_.emplace_back();
    }
    return blocks_[found->second];
  }

  /// The same block, or null if there is none.
  [[nodiscard]] const CellBlock* find(std::uint64_t block) const {
    const auto found = numbers_.find(block);
    return found == numbers_.end() ? nullptr : &blocks_[found->second];
  }

  void occupy(CellCode cell) {
    block(cell >> kBlockBits).occupied[cell >> 6 & 7] |= std::uint64_t{1} << (cell & 63);
  }

  [[nodiscard]] std::size_t size() const { return blocks_.size(); }
  /// Name and content of the `i`-th block, in order of making.
  [[nodiscard]] std::uint64_t name(std::size_t i) const { return names_[i]; }
  [[nodiscard]] const CellBlock& content(std::size_t i) const { return blocks_[i]; }

  /// Forgets all cells, keeps the memory.
  void clear() {
    numbers_.clear();
    names_.clear();
    blocks_.clear();
  }

 private:
  VoxelMap<std::uint32_t> numbers_;  ///< The number of each block by its name.
  std::vector<std::uint64_t> names_;
  std::vector<CellBlock> blocks_;
};

}  // namespace raymoval::octomap_method
