// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan_source.h"
#include "datasets/clouds/cloud_file.h"

namespace raymoval {

/// How a map is written so that coordinates lose no digits.
struct MapPrecision {
  /// The origin from which voxels are counted, see `lattice_origin`.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// float64 where a sensor is so far from the world's origin that float32 loses a millimetre.
  Coordinates coordinates = Coordinates::kFloat;
};
MapPrecision map_precision(const ScanSource& scans);

}  // namespace raymoval
