// SPDX-License-Identifier: MIT
// "Moving Object Segmentation ... using Hidden Markov Models"; the steps are those of hmm_mos.h.
#include "methods/hmm_mos/hmm_mos.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/scan/mask_store.h"
#include "core/text.h"
#include "methods/common/answers.h"
#include "methods/common/remover_from.h"
#include "methods/hmm_mos/belief_map.h"
#include "methods/hmm_mos/moving_voxels.h"

namespace raymoval::hmm_mos_method {
namespace {

/// Step 12: removes the points whose voxel `moves`.
template <class Moves>
Mask mask_of(const Scan& scan, const Parameters& parameters, Moves&& moves) {
  Mask mask(scan.size(), 0);
  const Lattice lattice(parameters);
  for (std::size_t k = 0; k < scan.size(); ++k) {
    if (!counts(scan.points[k], parameters)) continue;
    const VoxelIndex voxel = lattice.voxel_of(scan.T_world_sensor * scan.points[k].cast<double>());
    mask[k] = moves(voxel_key(voxel)) ? 1 : 0;
  }
  return mask;
}

/// Steps 3 to 11 for a scan. @param before the voxels of the previous scan, replaced by this scan's
void take_in(const Scan& scan, ScanVoxels& voxels, const RunContext& context, ScanVoxels& before,
             BeliefMap& map, MovingVoxels& moving) {
  {
    const StageScope timed(context.times, "belief");
    map.observe(voxels, before, context);
  }
  {
    const StageScope timed(context.times, "forgetting");
    map.forget(scan.T_world_sensor.translation());
  }
  const StageScope timed(context.times, "change");
  moving.add(voxels.grid, map);
  std::swap(before, voxels);
}

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  BeliefMap map(parameters);
  MovingVoxels moving(parameters);
  ScanVoxels before;
  std::vector<ScanVoxels> voxels(scans_in_a_batch(scans, context));
  MaskStore moved(parameters.offline ? scans.size() : 0);
  for_scan_batches("hmm_mos", scans, context, [&](std::span<Scan> batch) {
    {
      const StageScope timed(context.times, "raycasting");
      parallel_for(context.threads, batch.size(), 1,
                   [&](std::size_t i) { find_voxels(batch[i], parameters, context, voxels[i]); });
    }
    for (std::size_t i = 0; i < batch.size(); ++i) {
      take_in(batch[i], voxels[i], context, before, map, moving);
      const StageScope timed(context.times, "answer");
      const Mask mask = mask_of(batch[i], parameters,
                                [&](VoxelKey voxel) { return moving.found().contains(voxel); });
      parameters.offline ? moved.set(batch[i].index, mask) : sink.accept(batch[i].index, mask);
    }
  });
  if (!parameters.offline) return;
  map.forget_all();
  const CellSet& free = map.forgotten_free();
  answer_scans("hmm_mos, answers", scans, sink, context, [&](const Scan& scan) {
    Mask mask = mask_of(scan, parameters, [&](VoxelKey voxel) { return free.contains(voxel); });
    const Mask online = moved.get(scan.index);
    std::transform(mask.begin(), mask.end(), online.begin(), mask.begin(), std::bit_or<>());
    return mask;
  });
}

}  // namespace

std::unique_ptr<Remover> make_hmm_mos(const Parameters& parameters) {
  if (!(parameters.min_range < parameters.max_range)) {
    throw ConfigurationError(
        "hmm_mos.min_range = " + number_text(parameters.min_range) +
        " is not below hmm_mos.max_range = " + number_text(parameters.max_range) +
        ", so no point would be judged; raise max_range.");
  }
  return remover_from(parameters, run);
}

}  // namespace raymoval::hmm_mos_method
