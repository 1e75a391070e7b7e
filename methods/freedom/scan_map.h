// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/scan/scan.h"
#include "methods/freedom/levels.h"

namespace raymoval::freedom_method {

/// Where voxels and their sub-voxels are.
class Lattice {
 public:
  explicit Lattice(const Parameters& parameters)
      : inverse_(1.0 / parameters.sub_voxel_size),
        per_edge_(parameters.sub_voxels),
        voxels_a_metre_(1.0 / parameters.voxel_size()) {}

  /// @param world metres @throws DataError beyond the common lattice
  [[nodiscard]] VoxelIndex sub_voxel_of(const Eigen::Vector3d& world) const {
    return voxel_index(world, inverse_);
  }
  /// The voxel that a sub-voxel lies in.
  [[nodiscard]] VoxelIndex voxel_of(const VoxelIndex& sub_voxel) const {
    if (per_edge_ == 4) return {sub_voxel.x() >> 2, sub_voxel.y() >> 2, sub_voxel.z() >> 2};
    // Numbers from 0 on, so that quotients are rounded down.
    const int offset = per_edge_ * kVoxelBias;
    return ((sub_voxel.array() + offset) / per_edge_ - kVoxelBias).matrix();
  }
  /// The place of a sub-voxel in its voxel, 0 to 63.
  [[nodiscard]] int place_of(const VoxelIndex& sub_voxel, const VoxelIndex& voxel) const {
    const VoxelIndex inside = sub_voxel - per_edge_ * voxel;
    return (inside.x() * per_edge_ + inside.y()) * per_edge_ + inside.z();
  }
  [[nodiscard]] VoxelIndex sub_voxel_at(const VoxelIndex& voxel, int place) const {
    return per_edge_ * voxel + VoxelIndex(place / (per_edge_ * per_edge_),
                                          place / per_edge_ % per_edge_, place % per_edge_);
  }
  /// A world point in voxels.
  [[nodiscard]] Eigen::Vector3d in_voxels(const Eigen::Vector3d& world) const {
    return world * voxels_a_metre_;
  }

 private:
  double inverse_;  ///< Sub-voxels a metre.
  int per_edge_;    ///< Sub-voxels along the edge of a voxel.
  double voxels_a_metre_;
};

/// A voxel in which a scan has points.
struct ScanVoxel {
  VoxelIndex at = VoxelIndex::Zero();
  Level level = Level::kStatic;
  std::uint64_t sub_voxels = 0;  ///< Those with a point, a bit each by their places.
  /// Of the points' places in the voxel, in whole 2^-24 of a voxel: sums do not depend on order.
  Eigen::Matrix<std::int64_t, 3, 1> sum = Eigen::Matrix<std::int64_t, 3, 1>::Zero();
  std::int64_t points = 0;

  void add(const Eigen::Vector3d& in_voxels, int place) {
    // Half a unit more and cut off: `std::round` takes as long as all the rest.
    sum += (((in_voxels - at.cast<double>()) * kUnit).array() + 0.5).cast<std::int64_t>().matrix();
    sub_voxels |= std::uint64_t{1} << place;
    ++points;
  }
  /// The mean of the points, in voxels.
  [[nodiscard]] Eigen::Vector3d mean() const {
    return at.cast<double>() + sum.cast<double>() / (kUnit * static_cast<double>(points));
  }

 private:
  static constexpr double kUnit = 1 << 24;
};

/// Step 1: the voxels of a scan.
class ScanMap {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// Replaces what there was; the memory is used again.
  void fill(const Scan& scan, const Parameters& parameters);

  [[nodiscard]] std::vector<ScanVoxel>& voxels() { return voxels_; }
  [[nodiscard]] const std::vector<ScanVoxel>& voxels() const { return voxels_; }
  /// The number of a voxel in `voxels()`; `kNone` if it has no point.
  [[nodiscard]] std::uint32_t find(const VoxelIndex& voxel) const {
    const auto found = numbers_.find(voxel_key(voxel));
    return found == numbers_.end() ? kNone : found->second;
  }
  /// Second part of step 2: grows levels from the conservative voxels.
  void grow(const Growth& growth);

 private:
  std::vector<ScanVoxel> voxels_;
  VoxelMap<std::uint32_t> numbers_;
};

}  // namespace raymoval::freedom_method
