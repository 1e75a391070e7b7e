// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

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

/// Free and occupied cells of (a part of) a scan, block by block. The table of blocks is one of its
/// own: with tsl::robin_map the whole method takes a quarter more time.
class CellBlocks {
 public:
  CellBlocks() : slots_(kFirstSlots) {}

  /// The block of all codes that begin with `block` (code >> kBlockBits). It is made if there is
  /// none. The reference holds until the next call.
  CellBlock& block(std::uint64_t block) {
    std::size_t at = slot_of(block);
    while (slots_[at].used) {
      if (slots_[at].block == block) return blocks_[slots_[at].number];
      at = (at + 1) & (slots_.size() - 1);
    }
    return add(block, at);
  }

  /// The same block, or null if there is none.
  [[nodiscard]] const CellBlock* find(std::uint64_t block) const {
    std::size_t at = slot_of(block);
    while (slots_[at].used && slots_[at].block != block) at = (at + 1) & (slots_.size() - 1);
    return slots_[at].used ? &blocks_[slots_[at].number] : nullptr;
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
    slots_.assign(slots_.size(), {});
    names_.clear();
    blocks_.clear();
  }

 private:
  struct Slot {
    std::uint64_t block = 0;
    std::uint32_t number = 0;
    bool used = false;
  };
  static constexpr std::size_t kFirstSlots = 1 << 12;

  [[nodiscard]] std::size_t slot_of(std::uint64_t block) const {
    const std::uint64_t hash = block * 0x9E3779B97F4A7C15ULL;
    return (hash ^ hash >> 32) & (slots_.size() - 1);
  }

  CellBlock& add(std::uint64_t block, std::size_t at) {
    slots_[at] = {block, static_cast<std::uint32_t>(blocks_.size()), true};
    names_.push_back(block);
    blocks_.emplace_back();
    if (2 * blocks_.size() > slots_.size()) grow();
    return blocks_.back();
  }

  void grow() {
    slots_.assign(2 * slots_.size(), {});
    for (std::size_t i = 0; i < names_.size(); ++i) {
      std::size_t at = slot_of(names_[i]);
      while (slots_[at].used) at = (at + 1) & (slots_.size() - 1);
      slots_[at] = {names_[i], static_cast<std::uint32_t>(i), true};
    }
  }

  std::vector<Slot> slots_;  ///< Open addressing; a power of two, at most half used.
  std::vector<std::uint64_t> names_;
  std::vector<CellBlock> blocks_;
};

}  // namespace raymoval::octomap_method
