// SPDX-License-Identifier: MIT
#include "core/voxel_key.h"

#include "core/error.h"
#include "core/text.h"

namespace raymoval {

void throw_voxel_out_of_range(double x, double y, double z, double voxel_size) {
  throw DataError("world point (" + number_text(x) + ", " + number_text(y) + ", " + number_text(z) +
                  ") m has no voxel of " + number_text(voxel_size) + " m: expected at most " +
                  grouped_text(kVoxelLimit) +
                  " voxels from the origin. Check the poses, or move the origin near the data.");
}

}  // namespace raymoval
