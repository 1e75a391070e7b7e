// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/map_precision.h"

#include "core/scan/local_frame.h"

namespace raymoval {

MapPrecision map_precision(const ScanSource& scans) {
  MapPrecision precision;
  precision.origin = lattice_origin(scans);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans.pose(i).translation().cwiseAbs().maxCoeff() > kFarFromOrigin) {
      precision.coordinates = Coordinates::kDouble;
    }
  }
  return precision;
}

}  // namespace raymoval
