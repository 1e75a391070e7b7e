// SPDX-License-Identifier: MIT
// "Moving Object Segmentation ... using Hidden Markov Models"; the steps are those of hmm_mos.h.
#include "methods/hmm_mos/hmm_mos.h"

#include <utility>

#include "core/parallel.h"
#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/hmm_mos/belief_map.h"
#include "methods/hmm_mos/moving_voxels.h"

namespace raymoval::hmm_mos_method {
namespace {

/// Step 12.
Mask mask_of(const Scan& scan, const Parameters& parameters, const VoxelSet& moving) {
  Mask mask(scan.size(), 0);
  if (moving.empty()) return mask;
  const Lattice lattice(parameters);
  for (std::size_t k = 0; k < scan.size(); ++k) {
    if (!counts(scan.points[k], parameters)) continue;
    const VoxelIndex voxel = lattice.voxel_of(scan.T_world_sensor * scan.points[k].cast<double>());
    mask[k] = moving.contains(voxel_key(voxel)) ? 1 : 0;
  }
  return mask;
}

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  BeliefMap map(parameters);
  MovingVoxels moving(parameters);
  std::vector<ScanGrid> grids(scans_in_a_batch(scans, context));
  ScanGrid before;
  for_scan_batches("hmm_mos", scans, context, [&](std::span<Scan> batch) {
    {
      const StageScope timed(context.times, "raycasting");
      parallel_for(context.threads, batch.size(), 1,
                   [&](std::size_t i) { find_voxels(batch[i], parameters, context, grids[i]); });
    }
    for (std::size_t i = 0; i < batch.size(); ++i) {  // In order of time.
      {
        const StageScope timed(context.times, "belief");
        map.observe(grids[i], before, context);
      }
      {
        const StageScope timed(context.times, "forgetting");
        map.forget(batch[i].T_world_sensor.translation());
      }
      {
        const StageScope timed(context.times, "change");
        moving.add(grids[i], map);
      }
      std::swap(before, grids[i]);
      const StageScope timed(context.times, "answer");
      sink.accept(batch[i].index, mask_of(batch[i], parameters, moving.found()));
    }
  });
}

}  // namespace

std::unique_ptr<Remover> make_hmm_mos(const Parameters& parameters) {
  return remover_from(parameters, run);
}

}  // namespace raymoval::hmm_mos_method
