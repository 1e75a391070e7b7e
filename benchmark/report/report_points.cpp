// SPDX-License-Identifier: MIT
#include "benchmark/report/report_points.h"

#include <algorithm>

namespace raymoval {
namespace {

/// The first size of cells if every point stayed until then.
constexpr int kFirstCell = kStepsPerVoxel / 4;
constexpr int kLargestCell = 1 << 24;

std::int64_t floor_divide(std::int64_t value, std::int64_t by) {
  return value >= 0 ? value / by : -((-value + by - 1) / by);
}

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  return VoxelKeyHash{}(hash * 0x9E3779B97F4A7C15ULL + value);
}

}  // namespace

// Two cells with the same 64-bit hash would be thinned as one: of a million cells that happens once
// in tens of millions of reports, and costs one point of a picture.
std::uint64_t ReportPoints::key(const ShownPoint& point, std::uint64_t group) const {
  std::uint64_t hash = group;
  for (const std::int32_t step : point.step) {
    hash = mixed(hash, static_cast<std::uint64_t>(floor_divide(step, cell_)));
  }
  return hash;
}

void ReportPoints::add(const ShownPoint& point, std::uint64_t group,
                       std::span<const std::uint8_t> verdict) {
  if (cell_ > 0 && !taken_.insert(key(point, group)).second) return;
  points_.push_back(point);
  groups_.push_back(group);
  bytes_.insert(bytes_.end(), verdict.begin(), verdict.end());
  while (points_.size() > limit_) grow_cells();
}

void ReportPoints::reduce(std::size_t limit) {
  limit_ = limit;
  while (points_.size() > limit_) grow_cells();
}

void ReportPoints::grow_cells() {
  if (cell_ > kLargestCell) {  // One point of each group is left: there are too many groups.
    points_.resize(limit_);
    groups_.resize(limit_);
    bytes_.resize(limit_ * verdicts_);
    return;
  }
  cell_ = cell_ == 0 ? kFirstCell : cell_ + std::max(1, cell_ / 4);
  taken_.clear();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!taken_.insert(key(points_[i], groups_[i])).second) continue;
    points_[kept] = points_[i];
    groups_[kept] = groups_[i];
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(i * verdicts_), verdicts_,
                bytes_.begin() + static_cast<std::ptrdiff_t>(kept * verdicts_));
    ++kept;
  }
  points_.resize(kept);
  groups_.resize(kept);
  bytes_.resize(kept * verdicts_);
}

}  // namespace raymoval
