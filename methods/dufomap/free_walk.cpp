// SPDX-License-Identifier: MIT
#include "methods/dufomap/free_walk.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace raymoval::dufomap {
namespace {

constexpr int kFraction = 40;
constexpr double kUnit = static_cast<double>(std::int64_t{1} << kFraction);
/// Farther than any beam reaches; 16 of it still fit in 63 bits.
constexpr double kFar = FreeWalk::kLongest;

std::int64_t fixed(double voxels) {
  return static_cast<std::int64_t>(std::clamp(voxels, -kFar, kFar) * kUnit);
}

}  // namespace

FreeWalk::FreeWalk(const Eigen::Vector3d& sensor, bool pass_through_hits, ScanGrid& grid)
    : pass_through_hits_(pass_through_hits),
      grid_(grid),
      sensor_block_(block_of(voxel_index(sensor, 1.0))),
      sensor_(sensor -
              sensor_block_.cwiseProduct(VoxelIndex(kSide, kSide, kHeight)).cast<double>()) {}

FreeWalk::Axis FreeWalk::axis_of(Eigen::Index k, const Eigen::Vector3d& direction) const {
  Axis axis{};
  axis.step = direction[k] < 0.0 ? -1 : 1;
  axis.to_column = k == 0 ? axis.step * kSide : axis.step;
  if (direction[k] == 0.0) {
    axis.next = axis.delta = fixed(kFar);
    return axis;
  }
  const double low = std::floor(sensor_[k]);
  const double delta = 1.0 / std::abs(direction[k]);
  const double next = (axis.step > 0 ? low + 1.0 - sensor_[k] : sensor_[k] - low) * delta;
  axis.next = fixed(next);
  axis.delta = fixed(delta);
  axis.height = fixed(sensor_.z() + next * direction.z());
  axis.rise = fixed(delta * direction.z());
  return axis;
}

/// When the beam leaves the block upwards or downwards.
FreeWalk::Fixed FreeWalk::height_exit(const Eigen::Vector3d& direction) const {
  if (direction.z() == 0.0) return fixed(kFar);
  const int wall = (block_at_.z() - sensor_block_.z() + (rises_ ? 1 : 0)) * kHeight;
  return fixed((wall - sensor_.z()) / direction.z());
}

/// Clamped, as the height at a wall may be rounded into the next block.
int FreeWalk::height_in_block(Fixed height) const {
  const Fixed low = Fixed{block_at_.z() - sensor_block_.z()} * kHeight;
  return static_cast<int>(std::clamp<Fixed>((height >> kFraction) - low, 0, kHeight - 1));
}

VoxelIndex FreeWalk::voxel() const {
  return {block_at_.x() * kSide + (column_ >> kSideBits),
          block_at_.y() * kSide + (column_ & (kSide - 1)), block_at_.z() * kHeight + z_};
}

/// Marks the voxels of a column from height `z_` to `to`, but none behind a hit.
/// @return true if there is a hit; `z_` is then its height, otherwise `to`
bool FreeWalk::mark(Column& column, int to) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  const auto between = [](int a, int b) {
    return (kAll << std::min(a, b)) & (kAll >> (kHeight - 1 - std::max(a, b)));
  };
  const std::uint64_t passed = between(z_, to);
  const std::uint64_t blocked = passed & column.hit;
  if (blocked == 0 || pass_through_hits_) {
    column.free |= passed;
    z_ = to;
    return false;
  }
  const int hit = rises_ ? std::countr_zero(blocked) : kHeight - 1 - std::countl_zero(blocked);
  column.free |= between(z_, hit);
  z_ = hit;
  return true;
}

/// Walks the columns of a block that the beam leaves before `limit`. @return true at a hit
bool FreeWalk::walk_block(ScanBlock& block, Fixed limit) {
  Axis x = x_, y = y_;  // Copies, so that they stay in registers.
  int column = column_;
  bool at_hit = false;
  while (true) {
    const Fixed y_first = (y.next - x.next) >> 63;  // All ones or all zeros.
    if (((y.next & y_first) | (x.next & ~y_first)) >= limit) break;
    const Fixed height = (y.height & y_first) | (x.height & ~y_first);
    at_hit = mark(block.columns[static_cast<std::size_t>(column)], height_in_block(height));
    if (at_hit) break;
    y.next += y.delta & y_first;
    y.height += y.rise & y_first;
    x.next += x.delta & ~y_first;
    x.height += x.rise & ~y_first;
    const int choice = static_cast<int>(y_first);
    column += (y.to_column & choice) | (x.to_column & ~choice);
  }
  x_ = x;
  y_ = y;
  column_ = column;
  return at_hit;
}

/// Marks the last column of a block and goes on to the next block. @return true at a hit
bool FreeWalk::leave_block(ScanBlock& block, const Eigen::Vector3d& direction, double length,
                           Fixed limit, const std::array<Fixed, 3>& exits) {
  Column& column = block.columns[static_cast<std::size_t>(column_)];
  if (limit == exits[0]) {
    if (mark(column, height_in_block(x_.height))) return true;
    x_.advance();
    block_at_.x() += x_.step;
    column_ = (column_ & (kSide - 1)) | (x_.step > 0 ? 0 : (kSide - 1) << kSideBits);
  } else if (limit == exits[1]) {
    if (mark(column, height_in_block(y_.height))) return true;
    y_.advance();
    block_at_.y() += y_.step;
    column_ = (column_ & ~(kSide - 1)) | (y_.step > 0 ? 0 : kSide - 1);
  } else if (limit == exits[2]) {
    if (mark(column, rises_ ? kHeight - 1 : 0)) return true;
    block_at_.z() += rises_ ? 1 : -1;
    z_ = rises_ ? 0 : kHeight - 1;
  } else {
    return mark(column, height_in_block(fixed(sensor_.z() + length * direction.z())));
  }
  return false;
}

VoxelIndex FreeWalk::mark_free(const Eigen::Vector3d& direction, double length) {
  x_ = axis_of(0, direction);
  y_ = axis_of(1, direction);
  rises_ = direction.z() >= 0.0;
  block_at_ = sensor_block_;
  const VoxelIndex start = sensor_.array().floor().cast<int>();
  column_ = static_cast<int>(column_of(start));
  z_ = start.z();
  const Fixed end = fixed(length);
  while (true) {
    ScanBlock& block = grid_.block(block_at_);
    const std::array<Fixed, 3> exits{x_.block_exit(column_ >> kSideBits),
                                     y_.block_exit(column_ & (kSide - 1)), height_exit(direction)};
    const Fixed exit = std::min({exits[0], exits[1], exits[2]});
    // A wall exactly at the end is not crossed.
    const bool ends_here = end <= exit;
    if (walk_block(block, ends_here ? end : exit)) return voxel();
    const std::array<Fixed, 3> none{-1, -1, -1};
    if (leave_block(block, direction, length, exit, ends_here ? none : exits) || ends_here) {
      return voxel();
    }
  }
}

}  // namespace raymoval::dufomap
