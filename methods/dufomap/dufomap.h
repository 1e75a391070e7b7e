// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"

namespace raymoval {
namespace dufomap_method {

/// Parameters of DUFOMap; defaults are those of its public configuration.
struct Parameters {
  double voxel_size = 0.1;
  double hit_extension = 0.2;
  int unknown_inflation = 1;
  bool compensate_inflation = true;
  double minimum_range = 0.2;
  double maximum_range = 0.0;
  bool offline = true;
};

/// D. Duberg, Q. Zhang, M. Jia, P. Jensfelt: "DUFOMap: Efficient Dynamic Awareness Mapping", RA-L
/// 2024. A voxel that one scan has observed as certainly free is a void; any point in a void is
/// dynamic. Per scan:
///  1. Points nearer than `minimum_range` are dropped; one beam goes to the centre of each voxel
///     that holds a point.
///  2. Hits: the voxels on the last `hit_extension` (d_s) metres of each beam.
///  3. Free: the voxels from the sensor to the first hit that the beam enters, and on until it has
///     advanced `unknown_inflation` (d_p) voxels along one axis.
///  4. Void: not a hit, and all (2 d_p + 1)^3 voxels around it free.
///  5. Voids of all scans are united and never reset; a point is dynamic iff its voxel is a void.
/// Decisions and deviations from the public code: `notes` of the entry.
std::unique_ptr<Remover> make_dufomap(const Parameters& parameters);

}  // namespace dufomap_method

MethodEntry dufomap_entry();

}  // namespace raymoval
