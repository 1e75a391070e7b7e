// SPDX-License-Identifier: MIT
#include "methods/hmm_mos/scan_voxels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raymoval::hmm_mos_method {
namespace {

/// A line from voxel to voxel by whole numbers (Bresenham). Each step goes one voxel along the axis
/// with the largest difference, and along another where its error is used up.
class LineWalk {
 public:
  LineWalk(ScanGrid& grid, const VoxelIndex& from, const VoxelIndex& to)
      : grid_(grid),
        length_((to - from).cwiseAbs().maxCoeff()),
        step_((to - from).cwiseSign()),
        difference_((to - from).cwiseAbs()),
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
      const int over = error_[axis] >> 31;  // All ones or all zeros: no branch to foretell.
      error_[axis] += length_ & over;
      place_[axis] += step_[axis] & over;
    }
    const auto level = static_cast<unsigned>(place_.x() | place_.y());
    if (level >= kSide || static_cast<unsigned>(place_.z()) >= kHeight) change_block();
  }

 private:
  void change_block() {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const int side = axis == 2 ? kHeight : kSide;
      if (place_[axis] >= 0 && place_[axis] < side) continue;
      block_ = &grid_.beside(*block_, axis, step_[axis]);
      place_[axis] -= step_[axis] * side;
    }
  }

  ScanGrid& grid_;
  int length_;
  VoxelIndex step_, difference_, error_;
  ScanBlock* block_;
  VoxelIndex place_;  ///< Of the voxel in its block.
};

/// Marks what a scan observes.
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
    // What lies so many steps along the ray is surely within range, or beyond: places of voxels
    // differ from points on the ray by less than kSlack.
    constexpr double kSlack = 4.0;
    const double voxels = (end - sensor_voxel_).cast<double>().norm();
    const double steps = voxels > 0.0 ? walk.length() / voxels : 1.0;  // To a voxel of way.
    const double reach = max_range_ / lattice_.size();
    const int sure = std::min(walk.length(), static_cast<int>((reach - kSlack) * steps));
    const int last = std::min(walk.length(), static_cast<int>((reach + kSlack) * steps) + 1);
    int step = 0;
    for (; step < sure; ++step, walk.advance()) walk.mark();
    for (;; ++step, walk.advance()) {
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

/// Step 1, and the end of step 2: marks what is occupied within range.
/// @return where rays end, each voxel once, those out of range too
std::vector<VoxelIndex> ray_ends(const Scan& scan, const Parameters& parameters,
                                 const Lattice& lattice, const Observation& observation,
                                 ScanGrid& grid) {
  std::vector<VoxelIndex> ends;
  VoxelSet beyond;  // Blocks of the grid would take memory for each point far away.
  for (const Eigen::Vector3f& point : scan.points) {
    if (!counts(point, parameters)) continue;
    const VoxelIndex voxel = lattice.voxel_of(scan.T_world_sensor * point.cast<double>());
    if (!observation.is_within_range(voxel)) {
      if (beyond.insert(voxel_key(voxel)).second) ends.push_back(voxel);
      continue;
    }
    std::uint64_t& occupied = grid.column(voxel).hit;
    if ((occupied & bit_of(voxel)) != 0) continue;
    occupied |= bit_of(voxel);
    ends.push_back(voxel);
  }
  return ends;
}

}  // namespace

void find_voxels(const Scan& scan, const Parameters& parameters, const RunContext& context,
                 ScanGrid& grid) {
  constexpr std::size_t kRaysInTurn = 512;  // Between two questions whether to stop.
  grid.clear();
  const Lattice lattice(parameters);
  Observation observation(lattice, scan.T_world_sensor.translation(), parameters.max_range, grid);
  const std::vector<VoxelIndex> ends = ray_ends(scan, parameters, lattice, observation, grid);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (i % kRaysInTurn == 0) context.check_cancelled();
    observation.cast_ray(ends[i]);
  }
}

}  // namespace raymoval::hmm_mos_method
