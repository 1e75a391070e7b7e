// SPDX-License-Identifier: MIT
#include "methods/common/scan_grid.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"

namespace raymoval::scan_grid {
namespace {

using Fixed = std::int64_t;  ///< Voxels times 2^40.

/// A length in fixed point. It is limited to `kLongest`, which no beam reaches, so that its product
/// with a block's side still fits.
Fixed fixed(double voxels) {
  constexpr double kUnit = static_cast<double>(Fixed{1} << 40);
  return static_cast<Fixed>(std::min(voxels, FreeWalk::kLongest) * kUnit);
}

/// The distance along a beam to its next wall of an axis, and between walls after it.
struct Axis {
  Fixed next, delta;
  int step;  ///< +1 or -1.

  Axis(double place, double direction) : step(direction < 0.0 ? -1 : 1) {
    const double low = std::floor(place);
    // Bounded, so that 0 times it is 0: a line this flat that starts on a wall crosses it at once.
    const double period =
        direction == 0.0 ? FreeWalk::kLongest : std::min(1.0 / std::abs(direction), 1e300);
    next = fixed(direction == 0.0 ? period : (step > 0 ? low + 1.0 - place : place - low) * period);
    delta = fixed(period);
  }
  /// Distance at which the beam leaves the block; `cell` voxels of the block are below it along the
  /// axis.
  [[nodiscard]] Fixed block_exit(int cell) const {
    return next + (step > 0 ? kSide - 1 - cell : cell) * delta;
  }
};

/// The walk of a beam from voxel to voxel after Amanatides and Woo (1987). Most beams are nearly
/// level, so the inner loop walks the columns of one block at one height: integer arithmetic
/// without branches on the direction, which processors cannot predict.
class Walk {
 public:
  /// @param sensor from the low corner of `block`
  Walk(ScanGrid& grid, const VoxelIndex& block, const Eigen::Vector3d& sensor,
       const Eigen::Vector3d& direction, double length)
      : grid_(grid),
        x_(sensor.x(), direction.x()),
        y_(sensor.y(), direction.y()),
        z_(sensor.z(), direction.z()),
        end_(fixed(length)),
        block_(&grid.block(block)),
        column_(static_cast<int>(column_of(sensor.array().floor().cast<int>()))),
        height_(static_cast<int>(sensor.z())) {}

  /// Marks all voxels. @return the last
  VoxelIndex run() {
    while (true) {
      const Fixed x_exit = x_.block_exit(column_ / kSide);
      const Fixed y_exit = y_.block_exit(column_ % kSide);
      const Fixed exit = std::min(x_exit, y_exit);
      const Fixed level = std::min(exit, z_.next + 1);  // At an edge, x and y come before z.
      if (walk_level(std::min(level, end_)) || end_ <= std::min(exit, z_.next)) break;
      if (z_.next < exit) {
        change_height();
      } else if (x_exit <= y_exit) {
        leave_along_x();
      } else {
        leave_along_y();
      }
    }
    return {block_->at.x() * kSide + column_ / kSide, block_->at.y() * kSide + column_ % kSide,
            block_->at.z() * kHeight + height_};
  }

 private:
  /// Marks the voxels entered before `limit` at the current height, in the current block.
  /// @return true at a hit
  bool walk_level(Fixed limit) {
    Column* const columns = block_->columns.data();
    const std::uint64_t free = std::uint64_t{1} << height_;
    const int x_step = x_.step * kSide, y_minus_x = y_.step - x_step;
    const Fixed x_delta = x_.delta, y_delta = y_.delta;
    // The distance of the next x wall, and from it to the next y wall. Copies stay in registers.
    Fixed x = x_.next, lead = y_.next - x;
    int column = column_;
    bool at_hit = false;
    while (true) {
      Column& here = columns[column];
      here.free |= free;
      at_hit = (here.hit & free) != 0;
      const Fixed y_first = lead >> 63;  // All ones or all zeros.
      if (at_hit || x + (lead & y_first) >= limit) break;
      x += x_delta & ~y_first;
      const Fixed after_y = lead + y_delta, after_x = lead - x_delta;
      lead = lead < 0 ? after_y : after_x;
      column += x_step + (y_minus_x & static_cast<int>(y_first));
    }
    x_.next = x;
    y_.next = x + lead;
    column_ = column;
    return at_hit;
  }

  void leave_along_x() {
    x_.next += x_.delta;
    column_ -= x_.step * (kSide - 1) * kSide;
    block_ = &grid_.beside(*block_, 0, x_.step);
  }
  void leave_along_y() {
    y_.next += y_.delta;
    column_ -= y_.step * (kSide - 1);
    block_ = &grid_.beside(*block_, 1, y_.step);
  }
  void change_height() {
    z_.next += z_.delta;
    height_ += z_.step;
    if (height_ >= 0 && height_ < kHeight) return;
    height_ = z_.step > 0 ? 0 : kHeight - 1;
    block_ = &grid_.beside(*block_, 2, z_.step);
  }

  ScanGrid& grid_;
  Axis x_, y_, z_;
  Fixed end_;
  ScanBlock* block_;
  int column_;
  int height_;  ///< Of the voxel in its block.
};

}  // namespace

ScanBlock& ScanGrid::add_block(const VoxelIndex& at, VoxelKey key) {
  if (used_ >= kMostBlocks) {
    throw DataError("the beams of one scan cross more than " +
                    grouped_text(kMostBlocks * kSide * kSide * kHeight) +
                    " voxels; expected points within reach of a LiDAR. " + remedy_);
  }
  index_.emplace(key, static_cast<std::uint32_t>(used_));
  if (used_ == blocks_.size()) blocks_.push_back(std::make_unique<ScanBlock>());
  ScanBlock& block = *blocks_[used_++];
  block.at = at;
  block.beside = {};
  block.columns.fill(Column{});
  return block;
}

FreeWalk::FreeWalk(const Eigen::Vector3d& sensor, ScanGrid& grid)
    : grid_(grid),
      sensor_block_(block_of(voxel_index(sensor, 1.0))),
      sensor_(sensor -
              sensor_block_.cwiseProduct(VoxelIndex(kSide, kSide, kHeight)).cast<double>()) {}

VoxelIndex FreeWalk::mark_free(const Eigen::Vector3d& direction, double length) {
  return Walk(grid_, sensor_block_, sensor_, direction, length).run();
}

}  // namespace raymoval::scan_grid
