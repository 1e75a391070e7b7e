// SPDX-License-Identifier: MIT
#include "methods/peopleremover/lattice_scan.h"

namespace raymoval::peopleremover_method {

void put_on_lattice(const Scan& scan, const Parameters& parameters, LatticeScan& result) {
  const double inverse = 1.0 / parameters.voxel_size;
  const double minimum = parameters.effective_minimum_range();
  const Eigen::Vector3d position = scan.T_world_sensor.translation();
  voxel_index(position, inverse);  // Throws if the sensor is beyond the lattice.
  result.sensor = position * inverse;
  result.index.clear();
  result.local.clear();
  result.world.clear();
  result.voxels.clear();
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const Eigen::Vector3d local = scan.points[k].cast<double>();
    if (!(local.squaredNorm() > minimum * minimum)) continue;
    const Eigen::Vector3d world = scan.T_world_sensor * local;
    result.index.push_back(static_cast<std::uint32_t>(k));
    result.local.push_back(local);
    result.world.emplace_back(world * inverse);
    result.voxels.push_back(voxel_index(world, inverse));
  }
}

}  // namespace raymoval::peopleremover_method
