// SPDX-License-Identifier: MIT
// "DUFOMap: Efficient Dynamic Awareness Mapping"; the steps are numbered in dufomap.h.
#include "methods/dufomap/dufomap.h"

#include "core/parallel.h"
#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/dufomap/beams.h"
#include "methods/dufomap/void_map.h"

namespace raymoval::dufomap_method {
namespace {

/// What the steps find out about one scan; its memory is used again for later scans.
struct ScanWork {
  std::vector<VoxelIndex> voxels;  ///< The voxel of each point.
  ScanGrid grid{"Set dufomap.maximum_range to bound beams, or a larger dufomap.voxel_size."};
  ScanVoids voids;
  StageTimes times;
};

/// Steps 1 to 4. The result for a scan does not depend on any other scan.
void find_voids_of(const Scan& scan, const Parameters& parameters, const RunContext& context,
                   ScanWork& work) {
  work.grid.clear();
  std::vector<VoxelIndex> ends;
  {
    const StageScope timed(&work.times, "binning");
    work.voxels = voxels_of(scan, parameters.voxel_size);
    ends = beam_ends(scan, work.voxels, parameters, work.grid);
  }
  {
    const StageScope timed(&work.times, "raycasting");
    cast_beams(scan, ends, parameters, work.grid, context);
  }
  const StageScope timed(&work.times, "voids");
  find_voids(work.grid, parameters.unknown_inflation, work.voids);
}

/// The first half of step 5.
void integrate(ScanWork& work, VoidMap& voids) {
  const StageScope timed(&work.times, "integration");
  voids.add(work.voids);
}

/// The second half of step 5.
void answer(const Scan& scan, ScanWork& work, const VoidMap& voids, RemovalSink& sink) {
  const StageScope timed(&work.times, "answer");
  sink.accept(scan.index, voids.contain(work.voxels));
}

/// Calls `visit(scans, work)` with the scans of each batch and the work memory of each of them.
template <class Visit>
void for_each_batch(const char* what, const ScanSource& scans, const RunContext& context,
                    Visit&& visit) {
  std::vector<ScanWork> work(scans_in_a_batch(scans, context));
  for_scan_batches(what, scans, context, [&](std::span<Scan> batch) { visit(batch, work); });
  if (context.times == nullptr) return;
  // The scans of a batch are worked on at the same time, but for their integration.
  for (const ScanWork& one : work) {
    for (const StageTimes::Stage& stage : one.times.stages()) {
      const std::size_t at_once = stage.name == "integration" ? 1 : work.size();
      context.times->add(stage.name, stage.seconds / static_cast<double>(at_once));
    }
  }
}

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  VoidMap voids;
  for_each_batch("dufomap", scans, context, [&](std::span<Scan> batch, auto& work) {
    parallel_for(context.threads, batch.size(), 1,
                 [&](std::size_t i) { find_voids_of(batch[i], parameters, context, work[i]); });
    for (std::size_t i = 0; i < batch.size(); ++i) {  // In order of time.
      integrate(work[i], voids);
      if (!parameters.offline) answer(batch[i], work[i], voids, sink);
    }
  });
  if (!parameters.offline) return;
  for_each_batch("dufomap, answers", scans, context, [&](std::span<Scan> batch, auto& work) {
    parallel_for(context.threads, batch.size(), 1, [&](std::size_t i) {
      work[i].voxels = voxels_of(batch[i], parameters.voxel_size);
      answer(batch[i], work[i], voids, sink);
    });
  });
}

}  // namespace

std::unique_ptr<Remover> make_dufomap(const Parameters& parameters) {
  return remover_from(parameters, run);
}

}  // namespace raymoval::dufomap_method
