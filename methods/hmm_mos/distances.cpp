// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/distances.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace raymoval::hmm_mos_method {
namespace {

constexpr std::size_t kPart = 16;  ///< Bytes of a row that are worked on at once.

using Part = std::array<std::uint8_t, kPart>;

Part load(const std::uint8_t* bytes) {
  Part part;
  std::copy_n(bytes, kPart, part.begin());
  return part;
}

/// Takes in what lies `away` (squared) to the side: it is so much less near, and the nearest
/// counts.
void take_nearer(const std::uint8_t* from, std::uint8_t away, Part& nearest) {
  for (std::size_t k = 0; k < kPart; ++k) {
    const std::uint8_t above = std::max(from[k], away);
    nearest[k] = std::max(nearest[k], static_cast<std::uint8_t>(above - away));
  }
}

std::uint8_t squared(int distance) {
  return static_cast<std::uint8_t>(distance * distance);
}

/// The low `count` bits.
constexpr std::uint64_t low_bits(int count) {
  return (std::uint64_t{1} << count) - 1;
}

}  // namespace

DistanceField::DistanceField(int far)
    : far_(far),
      margin_(static_cast<int>(std::ceil(std::sqrt(far))) - 1),
      width_(kSide + 2 * margin_),
      of_columns_(static_cast<std::size_t>(width_ * width_)),
      of_rows_(static_cast<std::size_t>(width_ * kSide)),
      columns_(static_cast<std::size_t>(width_)),
      rows_(static_cast<std::size_t>(width_)),
      nearness_(kColumns) {
  const int farthest = kHeight + margin_;
  for (int difference = -farthest; difference <= farthest; ++difference) {
    ramp_.push_back(static_cast<std::uint8_t>(std::max(0, far_ - difference * difference)));
  }
}

void DistanceField::find(const ScanGrid& now, const ScanGrid& before, const ScanBlock& block) {
  find_heights(block);
  find_neighbours(now, before, block);
  along_z();
  along_y();
  along_x(block);
}

void DistanceField::find_heights(const ScanBlock& block) {
  std::uint64_t observed = 0;
  for (const Column& column : block.columns) observed |= column.observed;
  first_part_ = static_cast<std::size_t>(std::countr_zero(observed)) / kPart;
  last_part_ =
      observed == 0 ? 0 : static_cast<std::size_t>(63 - std::countl_zero(observed)) / kPart;
}

void DistanceField::find_neighbours(const ScanGrid& now, const ScanGrid& before,
                                    const ScanBlock& block) {
  for (int i = 0; i < 27; ++i) {
    const VoxelIndex at = block.at + VoxelIndex(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1);
    around_[0][static_cast<std::size_t>(i)] = now.find(at);
    around_[1][static_cast<std::size_t>(i)] = before.find(at);
  }
}

/// @param x, y from the block's first column
DistanceField::Occupied DistanceField::occupied(int x, int y) const {
  const int stack = ((x >> kSideBits) + 1) * 9 + ((y >> kSideBits) + 1) * 3;
  const std::size_t column = column_at(x & (kSide - 1), y & (kSide - 1));
  std::array<std::uint64_t, 3> words{};
  for (const auto& blocks : around_) {
    for (int z = 0; z < 3; ++z) {
      const ScanBlock* block = blocks[static_cast<std::size_t>(stack + z)];
      if (block != nullptr) words[static_cast<std::size_t>(z)] |= block->columns[column].occupied;
    }
  }
  return {margin_ == 0 ? 0 : words[0] >> (kHeight - margin_), words[1],
          words[2] & low_bits(margin_)};
}

void DistanceField::along_z() {
  const int farthest = kHeight + margin_;
  const auto take = [&](std::uint64_t bits, int first, Row& row) {
    for (; bits != 0; bits &= bits - 1) {
      const std::uint8_t* ramp =
          &ramp_[static_cast<std::size_t>(farthest - (first + std::countr_zero(bits)))];
      for (std::size_t part = first_part_; part <= last_part_; ++part) {
        Part nearest = load(&row[part * kPart]);
        take_nearer(ramp + part * kPart, 0, nearest);
        std::copy_n(nearest.begin(), kPart, &row[part * kPart]);
      }
    }
  };
  for (int x = 0; x < width_; ++x) {
    std::uint64_t& columns = columns_[static_cast<std::size_t>(x)];
    columns = 0;
    for (int y = 0; y < width_; ++y) {
      const Occupied bits = occupied(x - margin_, y - margin_);
      if ((bits.below | bits.here | bits.above) == 0) continue;
      columns |= std::uint64_t{1} << y;
      Row& row = of_columns_[static_cast<std::size_t>(x * width_ + y)];
      row.fill(0);
      take(bits.below, -margin_, row);
      take(bits.here, 0, row);
      take(bits.above, kHeight, row);
    }
  }
}

void DistanceField::along_y() {
  for (int x = 0; x < width_; ++x) {
    const std::uint64_t columns = columns_[static_cast<std::size_t>(x)];
    std::uint32_t& rows = rows_[static_cast<std::size_t>(x)];
    rows = 0;
    for (int y = 0; y < kSide; ++y) {
      const std::uint64_t near = columns >> y & low_bits(2 * margin_ + 1);
      if (near == 0) continue;
      rows |= std::uint32_t{1} << y;
      Row& row = of_rows_[static_cast<std::size_t>(x * kSide + y)];
      const Row* from = &of_columns_[static_cast<std::size_t>(x * width_ + y)];
      for (std::size_t part = first_part_; part <= last_part_; ++part) {
        Part nearest{};
        for (std::uint64_t bits = near; bits != 0; bits &= bits - 1) {
          const int k = std::countr_zero(bits);
          take_nearer(&from[k][part * kPart], squared(k - margin_), nearest);
        }
        std::copy_n(nearest.begin(), kPart, &row[part * kPart]);
      }
    }
  }
}

void DistanceField::along_x(const ScanBlock& block) {
  for (int y = 0; y < kSide; ++y) {
    std::uint64_t rows = 0;  // Bit x, if there is something.
    for (int x = 0; x < width_; ++x) {
      rows |= std::uint64_t{rows_[static_cast<std::size_t>(x)] >> y & 1U} << x;
    }
    for (int x = 0; x < kSide; ++x) {
      const std::size_t column = column_at(x, y);
      if (block.columns[column].observed == 0) continue;
      for (std::size_t part = first_part_; part <= last_part_; ++part) {
        Part nearest{};
        for (std::uint64_t bits = rows >> x & low_bits(2 * margin_ + 1); bits != 0;
             bits &= bits - 1) {
          const int k = std::countr_zero(bits);
          const Row& from = of_rows_[static_cast<std::size_t>((x + k) * kSide + y)];
          take_nearer(&from[part * kPart], squared(k - margin_), nearest);
        }
        std::copy_n(nearest.begin(), kPart, &nearness_[column][part * kPart]);
      }
    }
  }
}

}  // namespace raymoval::hmm_mos_method
