// SPDX-License-Identifier: MIT
#include "core/scan/voxel_key.h"

#include "core/error.h"
#include "core/scan/reach.h"
#include "core/text.h"

namespace raymoval {

void throw_voxel_out_of_range(double x, double y, double z, double voxel_size) {
  throw DataError("point (" + number_text(x) + ", " + number_text(y) + ", " + number_text(z) +
                  ") m from the first scan, or from the world's origin near it, has no voxel of " +
                  number_text(voxel_size) + " m: expected at most " + grouped_text(kVoxelLimit) +
                  " voxels (" + fixed_text(lattice_reach(voxel_size), 0) +
                  " m). Check that poses and points are metres (`raymoval inspect`).");
}

}  // namespace raymoval
