// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/voxel_key.h"
#include "methods/common/scan_passes.h"

namespace raymoval {

/// The mask of a scan: a point is removed if `is_removed(voxel)` is true for its voxel.
/// @param voxel_size edge of a voxel of the world's lattice, metres
template <class IsRemoved>
Mask mask_by_voxel(const Scan& scan, double voxel_size, IsRemoved&& is_removed) {
  Mask mask(scan.size());
  const double inverse = 1.0 / voxel_size;
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[k].cast<double>();
    mask[k] = is_removed(voxel_index(world, inverse)) ? 1 : 0;
  }
  return mask;
}

/// The last pass of an offline method, timed as the stage "answers": computes `mask_of(scan)` on
/// any thread and passes it to the sink.
template <class MaskOf>
void answer_scans(const char* what, const ScanSource& scans, RemovalSink& sink,
                  const RunContext& context, MaskOf&& mask_of) {
  for_scans_at_once(what, "answers", scans, context, [&](const Scan& scan) {
    const StageScope timed(context.threads > 1 ? nullptr : context.times, "answers");
    sink.accept(scan.index, mask_of(scan));
  });
}

}  // namespace raymoval
