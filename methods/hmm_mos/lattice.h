// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/voxel_key.h"
#include "methods/hmm_mos/parameters.h"

namespace raymoval::hmm_mos_method {

/// Where voxels are.
class Lattice {
 public:
  explicit Lattice(const Parameters& parameters)
      : size_(parameters.voxel_size),
        inverse_(1.0 / parameters.voxel_size),
        corner_(parameters.public_lattice) {}

  /// The voxel of a point. @param world metres
  /// @throws DataError beyond the common lattice
  [[nodiscard]] VoxelIndex voxel_of(const Eigen::Vector3d& world) const {
    if (!corner_) return voxel_index(world, inverse_);
    const VoxelIndex magnitude = voxel_index(world.cwiseAbs(), inverse_);
    return (world.array() < 0.0).select(-magnitude, magnitude);
  }
  /// The voxel in which rays begin. @param world metres
  [[nodiscard]] VoxelIndex sensor_voxel(const Eigen::Vector3d& world) const {
    return voxel_index(world, inverse_);
  }
  /// From where the distance to a voxel counts, metres.
  [[nodiscard]] Eigen::Vector3d position(const VoxelIndex& voxel) const {
    return (voxel.cast<double>().array() + (corner_ ? 0.0 : 0.5)).matrix() * size_;
  }
  [[nodiscard]] double size() const { return size_; }  ///< Edge of a voxel, metres.

 private:
  double size_, inverse_;
  bool corner_;
};

}  // namespace raymoval::hmm_mos_method
