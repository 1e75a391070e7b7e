// SPDX-License-Identifier: MIT
#include "methods/freedom/free_rays.h"

#include <algorithm>

#include "methods/common/free_walk.h"

namespace raymoval::freedom_method {
namespace {

constexpr double kAlmost = 1e-6;  ///< Voxels; far above the rounding of the walk.

/// The rays of one scan.
class Rays {
 public:
  Rays(const Eigen::Vector3d& sensor, const Parameters& parameters, scan_grid::ScanGrid& grid)
      : p_(parameters),
        scale_(1.0 / parameters.voxel_size()),
        sensor_(sensor * scale_),
        sensor_voxel_(voxel_index(sensor_, 1.0)),
        walk_(sensor_, false, grid) {}

  /// @param end relative to the sensor, along the world's axes, metres
  void cast(const Eigen::Vector3d& end) {
    const double length = end.norm();
    if (length == 0.0) return;
    const Eigen::Vector3d cut = end * (share_within_reach(end, length) * scale_);
    const Eigen::Vector3d direction = end / length;
    const double entry = entry_of(voxel_index(sensor_ + cut, 1.0), direction);
    if (entry >= 0.0) walk_.mark_free(direction, std::max(0.0, entry - kAlmost));
  }

 private:
  /// The share of a ray that lies in the range and between the heights of rays.
  [[nodiscard]] double share_within_reach(const Eigen::Vector3d& end, double length) const {
    double share = std::min(1.0, p_.ray_range / length);
    if (end.z() > p_.ray_highest) share = std::min(share, p_.ray_highest / end.z());
    if (end.z() < p_.ray_lowest) share = std::min(share, p_.ray_lowest / end.z());
    return share;
  }
  /// Where a ray enters its last voxel; negative if it is the sensor's own.
  [[nodiscard]] double entry_of(const VoxelIndex& last, const Eigen::Vector3d& direction) const {
    double entry = -1.0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (last[k] == sensor_voxel_[k]) continue;
      const int wall = last[k] > sensor_voxel_[k] ? last[k] : last[k] + 1;
      entry = std::max(entry, (wall - sensor_[k]) / direction[k]);
    }
    return entry;
  }

  const Parameters& p_;
  double scale_;
  Eigen::Vector3d sensor_;  ///< In voxels.
  VoxelIndex sensor_voxel_;
  scan_grid::FreeWalk walk_;
};

}  // namespace

void cast_rays(const Scan& scan, const ScanMap& voxels,
               const std::vector<Eigen::Vector3d>& hole_ends, const Parameters& parameters,
               scan_grid::ScanGrid& grid, const RunContext& context) {
  constexpr std::size_t kRaysInTurn = 4096;  // Between two questions whether to stop.
  for (const ScanVoxel& voxel : voxels.voxels()) {
    grid.column(voxel.at).hit |= scan_grid::bit_of(voxel.at);
  }
  const Eigen::Vector3d sensor = scan.T_world_sensor.translation();
  Rays rays(sensor, parameters, grid);
  std::size_t count = 0;
  for (const ScanVoxel& voxel : voxels.voxels()) {
    if (++count % kRaysInTurn == 0) context.check_cancelled();
    rays.cast(voxel.mean() * parameters.voxel_size() - sensor);
  }
  for (const Eigen::Vector3d& end : hole_ends) {
    if (++count % kRaysInTurn == 0) context.check_cancelled();
    rays.cast(scan.T_world_sensor.linear() * end);
  }
}

}  // namespace raymoval::freedom_method
