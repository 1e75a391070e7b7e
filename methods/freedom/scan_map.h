// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/scan/scan.h"
#include "methods/common/sparse_blocks.h"
#include "methods/freedom/freedom.h"

namespace raymoval::freedom_method {

/// How surely something does not stay where it was seen. A point replaces those of a higher level.
enum class Level : std::uint8_t {
  kStatic,
  kAggressive,    ///< Near a moderate one.
  kModerate,      ///< Beside a conservative one.
  kConservative,  ///< In free space.
  kEmpty,         ///< There is no point any more.
};

/// The voxel that a sub-voxel lies in.
inline VoxelIndex voxel_of(const VoxelIndex& sub_voxel) {
  return {sub_voxel.x() >> 2, sub_voxel.y() >> 2, sub_voxel.z() >> 2};
}
/// The place of a sub-voxel in its voxel, 0 to 63, and back.
inline int place_of(const VoxelIndex& sub_voxel) {
  return (sub_voxel.x() & 3) << 4 | (sub_voxel.y() & 3) << 2 | (sub_voxel.z() & 3);
}
inline VoxelIndex sub_voxel_at(const VoxelIndex& voxel, int place) {
  return 4 * voxel + VoxelIndex(place >> 4, place >> 2 & 3, place & 3);
}

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
  void grow();

 private:
  std::vector<ScanVoxel> voxels_;
  VoxelMap<std::uint32_t> numbers_;
};

}  // namespace raymoval::freedom_method
