// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/scan_voxels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace raymoval::hmm_mos_method {
namespace {

/// A line from voxel to voxel by whole numbers (Bresenham). Each step goes one voxel along the axis
/// with the largest difference, and along another axis if its error overflows.
class LineWalk {
 public:
  LineWalk(ScanGrid& grid, const VoxelIndex& from, const VoxelIndex& to)
      : grid_(grid),
        step_((to - from).cwiseSign()),
        difference_((to - from).cwiseAbs()),
        length_(difference_.maxCoeff(&main_)),
        error_(VoxelIndex::Constant(length_ / 2)),
        block_(&grid.block(block_of(from))),
        place_(from.x() & (kSide - 1), from.y() & (kSide - 1), from.z() & (kHeight - 1)) {}

  [[nodiscard]] int length() const { return length_; }  ///< Steps to the end.
  void mark() {
    block_->columns[column_at(place_.x(), place_.y())].free |= std::uint64_t{1} << place_.z();
  }
  [[nodiscard]] VoxelIndex voxel() const {
    return block_->at.cwiseProduct(VoxelIndex(kSide, kSide, kHeight)) + place_;
  }
  void advance() {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      error_[axis] -= difference_[axis];
      if (error_[axis] >= 0) continue;
      error_[axis] += length_;
      place_[axis] += step_[axis];
      if (place_[axis] >= 0 && place_[axis] < side(axis)) continue;
      block_ = &grid_.beside(*block_, axis, step_[axis]);
      place_[axis] -= step_[axis] * side(axis);
    }
  }
  /// Marks and advances `steps` times.
  void mark_and_advance(int steps) {
    while (steps > 0) {
      const int inside = std::min(steps, steps_inside());
      mark_inside(inside);
      steps -= inside;
      if (steps == 0) return;
      mark();
      advance();
      --steps;
    }
  }

 private:
  static int side(Eigen::Index axis) { return axis == 2 ? kHeight : kSide; }

  /// The number of steps that stay in the block.
  [[nodiscard]] int steps_inside() const {
    int steps = length_;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (difference_[axis] == 0) continue;
      const int left = step_[axis] > 0 ? side(axis) - 1 - place_[axis] : place_[axis];
      steps = std::min(steps, (error_[axis] + left * length_) / difference_[axis]);
    }
    return steps;
  }

  /// `mark_and_advance` within the block. A place is one number, so that integer arithmetic
  /// advances it without branches, which processors cannot predict.
  void mark_inside(int steps) {
    constexpr std::array<int, 3> kStride{kSide * kHeight, kHeight, 1};
    const auto one = static_cast<Eigen::Index>(main_ == 0 ? 1 : 0);
    const auto other = static_cast<Eigen::Index>(main_ == 2 ? 1 : 2);
    const auto stride = [&](Eigen::Index axis) {
      return step_[axis] * kStride[static_cast<std::size_t>(axis)];
    };
    const int main_stride = stride(main_), one_stride = stride(one), other_stride = stride(other);
    const int one_difference = difference_[one], other_difference = difference_[other];
    const int length = length_;
    int one_error = error_[one], other_error = error_[other];
    int place = (place_.x() * kSide + place_.y()) * kHeight + place_.z();
    Column* const columns = block_->columns.data();
    for (int i = 0; i < steps; ++i) {
      columns[place >> kHeightBits].free |= std::uint64_t{1} << (place & (kHeight - 1));
      one_error -= one_difference;
      other_error -= other_difference;
      const int one_over = one_error >> 31, other_over = other_error >> 31;  // All ones or zeros.
      one_error += length & one_over;
      other_error += length & other_over;
      place += main_stride + (one_stride & one_over) + (other_stride & other_over);
    }
    error_[one] = one_error;
    error_[other] = other_error;
    place_ = {place / kHeight / kSide, place / kHeight % kSide, place % kHeight};
  }

  ScanGrid& grid_;
  VoxelIndex step_, difference_;
  Eigen::Index main_ = 0;  ///< The axis with the largest difference.
  int length_;
  VoxelIndex error_;
  ScanBlock* block_;
  VoxelIndex place_;  ///< Of the voxel in its block.
};

/// Marks the voxels that a scan observes.
class Observation {
 public:
  Observation(const Lattice& lattice, const Eigen::Vector3d& sensor, double max_range,
              ScanGrid& grid)
      : lattice_(lattice),
        sensor_(sensor),
        max_range_(max_range),
        sensor_voxel_(lattice.sensor_voxel(sensor)),
        grid_(grid) {}

  [[nodiscard]] bool is_within_range(const VoxelIndex& voxel) const {
    return (lattice_.position(voxel) - sensor_).squaredNorm() <= max_range_ * max_range_;
  }

  /// Marks the voxels of a ray that are within range.
  void cast_ray(const VoxelIndex& end) {
    LineWalk walk(grid_, sensor_voxel_, end);
    // Numbers of steps that are certainly within range, or beyond: voxel positions differ from
    // points on the ray by less than kSlack.
    constexpr double kSlack = 4.0;
    const double voxels = (end - sensor_voxel_).cast<double>().norm();
    const double steps = voxels > 0.0 ? walk.length() / voxels : 1.0;  // Per voxel of length.
    const double reach = max_range_ / lattice_.size();
    const int sure = std::min(walk.length(), static_cast<int>((reach - kSlack) * steps));
    const int last = std::min(walk.length(), static_cast<int>((reach + kSlack) * steps) + 1);
    walk.mark_and_advance(sure);
    for (int step = std::max(sure, 0);; ++step, walk.advance()) {
      if (is_within_range(walk.voxel())) walk.mark();
      if (step >= last) return;
    }
  }

 private:
  const Lattice& lattice_;
  Eigen::Vector3d sensor_;
  double max_range_;
  VoxelIndex sensor_voxel_;
  ScanGrid& grid_;
};

/// Step 1, and the end of step 2: separates occupied voxels within range from those beyond.
/// @return where rays end within range, each voxel once; those beyond are in `voxels.beyond`
std::vector<VoxelIndex> find_occupied(const Scan& scan, const Parameters& parameters,
                                      const Lattice& lattice, const Observation& observation,
                                      ScanVoxels& voxels) {
  std::vector<VoxelIndex> ends;
  VoxelSet beyond;  // Blocks of the grid would take memory for each distant point.
  for (const Eigen::Vector3f& point : scan.points) {
    if (!counts(point, parameters)) continue;
    const VoxelIndex voxel = lattice.voxel_of(scan.T_world_sensor * point.cast<double>());
    if (!observation.is_within_range(voxel)) {
      if (beyond.insert(voxel_key(voxel)).second) voxels.beyond.push_back(voxel);
      continue;
    }
    std::uint64_t& occupied = voxels.grid.column(voxel).hit;
    if ((occupied & bit_of(voxel)) != 0) continue;
    occupied |= bit_of(voxel);
    ends.push_back(voxel);
  }
  return ends;
}

/// Whether a grid has a block or one beside it, corners included.
bool is_near_block(const ScanGrid& grid, const VoxelIndex& block) {
  bool is_near = false;
  for_each_around(block, 1, [&](const VoxelIndex& at) { is_near |= grid.find(at) != nullptr; });
  return is_near;
}

}  // namespace

void find_voxels(const Scan& scan, const Parameters& parameters, const RunContext& context,
                 ScanVoxels& voxels) {
  constexpr std::size_t kRaysInTurn = 512;  // Between two checks for a cancel.
  voxels.grid.clear();
  voxels.beyond.clear();
  const Lattice lattice(parameters);
  Observation observation(lattice, scan.T_world_sensor.translation(), parameters.max_range,
                          voxels.grid);
  const std::vector<VoxelIndex> within =
      find_occupied(scan, parameters, lattice, observation, voxels);
  std::size_t rays = 0;
  for (const auto* ends : {&within, &std::as_const(voxels.beyond)}) {
    for (const VoxelIndex& end : *ends) {
      if (rays++ % kRaysInTurn == 0) context.check_cancelled();
      observation.cast_ray(end);
    }
  }
}

void find_beyond(const ScanVoxels& now, const ScanVoxels& before, ScanGrid& near) {
  near.clear();
  VoxelMap<bool> is_near;  // By block: many voxels share one.
  for (const ScanVoxels* voxels : {&now, &before}) {
    for (const VoxelIndex& voxel : voxels->beyond) {
      const VoxelIndex block = block_of(voxel);
      const auto [found, is_new] = is_near.try_emplace(voxel_key(block), false);
      if (is_new) found.value() = is_near_block(now.grid, block);
      if (found->second) near.column(voxel).hit |= bit_of(voxel);
    }
  }
}

}  // namespace raymoval::hmm_mos_method
