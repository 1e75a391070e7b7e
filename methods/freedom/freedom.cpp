// SPDX-License-Identifier: MIT
// "FreeDOM"; the steps are numbered in freedom.h.
#include "methods/freedom/freedom.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/freedom/depth_image.h"
#include "methods/freedom/free_map.h"
#include "methods/freedom/free_rays.h"
#include "methods/freedom/static_map.h"

namespace raymoval::freedom_method {
namespace {

/// What a scan says without the map; its memory is used again for later scans.
struct ScanWork {
  ScanMap voxels;
  scan_grid::ScanGrid rays{"Set a smaller freedom.ray_range, or a larger freedom.sub_voxel_size."};
  StageTimes times;
};

/// Steps 1, 3 and the first part of 4. They do not depend on any other scan.
void look(const Scan& scan, const DepthView& view, const Parameters& parameters,
          const RunContext& context, ScanWork& work) {
  work.rays.clear();
  {
    const StageScope timed(&work.times, "voxels");
    work.voxels.fill(scan, parameters);
  }
  std::vector<Eigen::Vector3d> hole_ends;
  {
    const StageScope timed(&work.times, "enhancement");
    hole_ends = find_hole_ends(scan, view, parameters);
  }
  const StageScope timed(&work.times, "raycasting");
  cast_rays(scan, work.voxels, hole_ends, parameters, work.rays, context);
}

/// Steps 2, the second part of 4, 5 and 6.
void take_in(std::size_t scan, const Parameters& parameters, ScanWork& work, FreeMap& free_map,
             StaticMap& static_map, StageTimes* times) {
  {
    const StageScope timed(times, "scan removal");
    free_map.take_hits(work.voxels);
    work.voxels.grow(growth_of(parameters, false));
  }
  std::vector<VoxelIndex> newly_free;
  {
    const StageScope timed(times, "free space");
    newly_free = free_map.take_passes(work.rays);
  }
  {
    const StageScope timed(times, "map removal");
    static_map.remove(newly_free);
  }
  const StageScope timed(times, "integration");
  static_map.integrate(work.voxels, scan);
}

/// Steps 1 to 6. @return the sub-voxels that are not in the map
CellSet build_map(const Parameters& parameters, const ScanSource& scans,
                  const RunContext& context) {
  const DepthView view = view_for(scans.sensor(), parameters);
  FreeMap free_map(parameters);
  StaticMap static_map(parameters);
  std::vector<ScanWork> work(scans_in_a_batch(scans, context));
  for_scan_batches("freedom", scans, context, [&](std::span<Scan> batch) {
    parallel_for(context.threads, batch.size(), 1,
                 [&](std::size_t i) { look(batch[i], view, parameters, context, work[i]); });
    for (std::size_t i = 0; i < batch.size(); ++i) {  // In order of time.
      take_in(batch[i].index, parameters, work[i], free_map, static_map, context.times);
    }
  });
  if (context.times != nullptr) {  // The scans of a batch are looked at side by side.
    for (const ScanWork& one : work) {
      for (const StageTimes::Stage& stage : one.times.stages()) {
        context.times->add(stage.name, stage.seconds / static_cast<double>(work.size()));
      }
    }
  }
  return static_map.removed();
}

/// Step 7.
void answer(const Parameters& parameters, const ScanSource& scans, const CellSet& removed,
            RemovalSink& sink, const RunContext& context) {
  const Lattice lattice(parameters);
  for_scans_at_once("freedom, answers", "answers", scans, context, [&](const Scan& scan) {
    const StageScope timed(context.threads > 1 ? nullptr : context.times, "answers");
    Mask mask(scan.size());
    std::transform(scan.points.begin(), scan.points.end(), mask.begin(),
                   [&](const Eigen::Vector3f& point) -> std::uint8_t {
                     const Eigen::Vector3d world = scan.T_world_sensor * point.cast<double>();
                     return removed.contains(voxel_key(lattice.sub_voxel_of(world))) ? 1 : 0;
                   });
    sink.accept(scan.index, mask);
  });
}

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  const CellSet removed = build_map(parameters, scans, context);
  answer(parameters, scans, removed, sink, context);
}

}  // namespace

std::unique_ptr<Remover> make_freedom(const Parameters& parameters) {
  if (parameters.minimum_range >= parameters.maximum_range) {
    throw ConfigurationError(
        "freedom.minimum_range must be below freedom.maximum_range, else no point is left.");
  }
  if (!parameters.view_of_sensor && parameters.view_bottom >= parameters.view_top) {
    throw ConfigurationError("freedom.view_bottom must be below freedom.view_top, in degrees.");
  }
  return remover_from(parameters, run);
}

}  // namespace raymoval::freedom_method
