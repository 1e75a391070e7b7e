// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/undecided_points.h"

#include <algorithm>

#include "core/parallel.h"
#include "eval/dynamicmap/marked_cells.h"
#include "eval/points/nearest_points.h"

namespace raymoval::dynamicmap {
namespace {

/// Memory of a kept point in the search tree.
constexpr std::size_t kTreeBytes = 16;
constexpr std::size_t kGrain = 4096;

}  // namespace

UndecidedPoints::UndecidedPoints(const Map& map, std::size_t room) : map_(map), room_(room) {}

void UndecidedPoints::begin(Number first, Number last) {
  is_near_flagged_ = RankedBits(map_.blocks.size());
  CellLattice::Cursor cursor;
  map_.blocks.for_each([&](Number number, VoxelKey block) {
    if (map_.flagged.any(number)) set_blocks_around(block, map_.blocks, cursor, is_near_flagged_);
  });
  first_ = first;
  end_ = last_ = last;
}

bool UndecidedPoints::begin_next() {
  first_ = end_;
  end_ = last_;
  return first_ < end_;
}

void UndecidedPoints::add(const Found& found) {
  for (const Flagged& point : found.flagged) {
    if (has_turn(point.block)) flagged_.push_back(point);
  }
  kept_.insert(kept_.end(), found.kept.begin(), found.kept.end());
  while (bytes() > room_ && narrow()) {
  }
}

std::size_t UndecidedPoints::bytes() const {
  return flagged_.size() * sizeof(Flagged) + kept_.size() * (sizeof(Eigen::Vector3d) + kTreeBytes);
}

/// Halves the flagged points by ending the range sooner. @return false if it is one block already
bool UndecidedPoints::narrow() {
  if (flagged_.empty() || end_ - first_ <= 1) return false;
  std::vector<Number> blocks;
  blocks.reserve(flagged_.size());
  for (const Flagged& point : flagged_) blocks.push_back(point.block);
  const auto middle = blocks.begin() + static_cast<std::ptrdiff_t>(blocks.size() / 2);
  std::nth_element(blocks.begin(), middle, blocks.end());
  const Number end = std::max(*middle, first_ + 1);
  if (end >= end_) return false;
  end_ = end;
  std::erase_if(flagged_, [&](const Flagged& point) { return point.block >= end; });
  CellLattice::Cursor cursor;
  std::erase_if(kept_, [&](const Eigen::Vector3d& point) {
    return !map_.flagged.any_near(map_.grid.cell_of(point), map_.blocks, cursor, first_, end);
  });
  flagged_.shrink_to_fit();
  kept_.shrink_to_fit();
  return true;
}

void UndecidedPoints::search(int threads, const std::function<void(const Flagged&)>& present) {
  const NearbyPoints<Eigen::Vector3d> near(kept_, map_.distance);
  std::vector<std::uint8_t> is_present(flagged_.size(), 0);
  parallel_for(threads, flagged_.size(), kGrain,
               [&](std::size_t i) { is_present[i] = near.has_near(flagged_[i].point) ? 1 : 0; });
  for (std::size_t i = 0; i < flagged_.size(); ++i) {
    if (is_present[i] != 0) present(flagged_[i]);
  }
  flagged_ = {};
  kept_ = {};
}

}  // namespace raymoval::dynamicmap
