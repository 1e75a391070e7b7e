// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/voxel_key.h"
#include "methods/peopleremover/parameters.h"

namespace raymoval::peopleremover_method {

/// The points of a scan that take part (farther than the minimum range), in scan order.
struct LatticeScan {
  Eigen::Vector3d sensor;              ///< Position of the sensor, voxel units.
  std::vector<std::uint32_t> index;    ///< Number of each point in its scan.
  std::vector<Eigen::Vector3d> local;  ///< Sensor frame, metres.
  std::vector<Eigen::Vector3d> world;  ///< World frame, voxel units (metres / voxel size).
  std::vector<VoxelIndex> voxels;      ///< floor(world).
  [[nodiscard]] std::size_t size() const { return index.size(); }
};

/// Step 2.1 of the reference: drops near points, and puts the others on the lattice. Reuses the
/// memory of `result`. @throws DataError if a point lies beyond the lattice.
void put_on_lattice(const Scan& scan, const Parameters& parameters, LatticeScan& result);

}  // namespace raymoval::peopleremover_method
