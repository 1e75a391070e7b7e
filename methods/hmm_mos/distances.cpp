// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/distances.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/simd/compiled_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/hmm_mos/distances.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
//
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace raymoval::hmm_mos_method {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::CappedTag<std::uint8_t, 64>;

void take_nearest(const NearRows& rows, std::size_t first, std::size_t last,
                  std::uint8_t* nearest) {
  const Bytes d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t at = first / lanes * lanes; at <= last; at += lanes) {
    auto most = hn::LoadU(d, nearest + at);
    for (std::uint64_t left = rows.which; left != 0; left &= left - 1) {
      const int row = std::countr_zero(left);
      const auto near = hn::LoadU(d, rows.rows + row * rows.stride + at);
      most = hn::Max(most, hn::SaturatedSub(near, hn::Set(d, rows.away[row])));
    }
    hn::StoreU(most, d, nearest + at);
  }
}

}  // namespace

TakeNearest take_nearest_kernel() {
  return &take_nearest;
}

}  // namespace HWY_NAMESPACE
}  // namespace raymoval::hmm_mos_method
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "core/simd/instruction_sets.h"

namespace raymoval::hmm_mos_method {
namespace {

/// The low `count` bits.
constexpr std::uint64_t low_bits(int count) {
  return (std::uint64_t{1} << count) - 1;
}

/// Occupied voxels in a column have distance 0 to the column.
constexpr std::array<std::uint8_t, kHeight> kNotAway{};

}  // namespace

HWY_EXPORT(take_nearest_kernel);

DistanceField::DistanceField(int far)
    : far_(far),
      margin_(static_cast<int>(std::ceil(std::sqrt(far))) - 1),
      width_(kSide + 2 * margin_),
      take_nearest_(RAYMOVAL_BEST_KERNEL(take_nearest_kernel)()),
      of_columns_(static_cast<std::size_t>(width_ * width_)),
      of_rows_(static_cast<std::size_t>(width_ * kSide)),
      nearness_(kColumns),
      columns_(static_cast<std::size_t>(width_)) {
  const int farthest = kHeight + margin_;
  for (int difference = -farthest; difference <= farthest; ++difference) {
    ramp_.push_back(static_cast<std::uint8_t>(std::max(0, far_ - difference * difference)));
  }
  for (int offset = -margin_; offset <= margin_; ++offset) {
    away_.push_back(static_cast<std::uint8_t>(offset * offset));
  }
}

void DistanceField::find(const ScanGrid& now, const ScanGrid& before, const ScanGrid& beyond,
                         const ScanBlock& block) {
  find_heights(block);
  find_neighbours({&now, &before, &beyond}, block);
  along_z();
  along_y();
  along_x(block);
}

void DistanceField::find_heights(const ScanBlock& block) {
  std::uint64_t observed = 0;
  for (const Column& column : block.columns) observed |= column.free;
  if (observed == 0) return;
  lowest_ = static_cast<std::size_t>(std::countr_zero(observed));
  highest_ = static_cast<std::size_t>(std::bit_width(observed)) - 1;
}

void DistanceField::find_neighbours(const std::array<const ScanGrid*, 3>& grids,
                                    const ScanBlock& block) {
  for_each_around(VoxelIndex::Zero(), 1, [&](const VoxelIndex& step) {
    const auto place = static_cast<std::size_t>(9 * step.x() + 3 * step.y() + step.z() + 13);
    for (std::size_t g = 0; g < grids.size(); ++g) {
      around_[g][place] = grids[g]->find(block.at + step);
    }
  });
}

void DistanceField::along_z() {
  for (int x = 0; x < width_; ++x) {
    find_occupied(x - margin_);
    columns_[static_cast<std::size_t>(x)] = 0;
    for (int y = 0; y < width_; ++y) {
      const auto at = static_cast<std::size_t>(y);
      const std::array<std::uint64_t, 3> occupied{
          margin_ == 0 ? 0 : occupied_[0][at] >> (kHeight - margin_), occupied_[1][at],
          occupied_[2][at] & low_bits(margin_)};
      if ((occupied[0] | occupied[1] | occupied[2]) == 0) continue;
      columns_[static_cast<std::size_t>(x)] |= std::uint64_t{1} << y;
      fill_column(occupied, of_columns_[static_cast<std::size_t>(x * width_ + y)]);
    }
  }
}

/// @param x of the block's first column
void DistanceField::find_occupied(int x) {
  for (auto& words : occupied_) words.fill(0);
  const auto stack = static_cast<std::size_t>((x >> kSideBits) + 1) * 9;
  for (const auto& blocks : around_) {
    for (std::size_t i = 0; i < 9; ++i) {
      const ScanBlock* block = blocks[stack + i];
      const int first = (static_cast<int>(i / 3) - 1) * kSide;  // From the block's first column.
      const int begin = std::max(first, -margin_);
      const int end = std::min(first + kSide, kSide + margin_);
      if (block == nullptr || begin >= end) continue;
      const Column* columns = &block->columns[column_at(x & (kSide - 1), begin - first)];
      std::uint64_t* words = &occupied_[i % 3][static_cast<std::size_t>(begin + margin_)];
      for (int y = begin; y < end; ++y) *words++ |= (columns++)->hit;
    }
  }
}

/// @param occupied of the column, below the block, in it, and above
void DistanceField::fill_column(const std::array<std::uint64_t, 3>& occupied, Row& row) const {
  constexpr std::ptrdiff_t kHigher = -1;  // The next higher ramp begins a byte earlier.
  const std::array<int, 3> first{-margin_, 0, kHeight};
  row.fill(0);
  for (std::size_t z = 0; z < 3; ++z) {
    if (occupied[z] == 0) continue;
    const std::uint8_t* ramp = &ramp_[static_cast<std::size_t>(kHeight + margin_ - first[z])];
    take_nearest_({ramp, kHigher, occupied[z], kNotAway.data()}, lowest_, highest_, row.data());
  }
}

void DistanceField::along_y() {
  rows_.fill(0);
  for (int x = 0; x < width_; ++x) {
    const std::uint64_t columns = columns_[static_cast<std::size_t>(x)];
    for (int y = 0; columns != 0 && y < kSide; ++y) {
      const std::uint64_t near = columns >> y & low_bits(2 * margin_ + 1);
      if (near == 0) continue;
      rows_[static_cast<std::size_t>(y)] |= std::uint64_t{1} << x;
      Row& row = of_rows_[static_cast<std::size_t>(x * kSide + y)];
      row.fill(0);
      const Row& from = of_columns_[static_cast<std::size_t>(x * width_ + y)];
      take_nearest_({from.data(), kHeight, near, away_.data()}, lowest_, highest_, row.data());
    }
  }
}

void DistanceField::along_x(const ScanBlock& block) {
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) {
      const std::size_t column = column_at(x, y);
      if (block.columns[column].free == 0) continue;
      Row& row = nearness_[column];
      row.fill(0);
      const std::uint64_t near =
          rows_[static_cast<std::size_t>(y)] >> x & low_bits(2 * margin_ + 1);
      const Row& from = of_rows_[static_cast<std::size_t>(x * kSide + y)];
      take_nearest_({from.data(), kSide * kHeight, near, away_.data()}, lowest_, highest_,
                    row.data());
    }
  }
}

}  // namespace raymoval::hmm_mos_method
#endif
