// SPDX-License-Identifier: MIT
// "FreeDOM"; the steps are numbered in freedom.h.
#include "methods/freedom/freedom.h"

#include <algorithm>

#include "core/error.h"
#include "methods/common/answers.h"
#include "methods/common/prepared_scans.h"
#include "methods/common/remover_from.h"
#include "methods/freedom/depth_image.h"
#include "methods/freedom/maps.h"

namespace raymoval::freedom_method {
namespace {

/// Results of a scan without the map; its memory is used again for later scans.
struct ScanWork {
  std::size_t scan = 0;
  ScanMap voxels;
  scan_grid::ScanGrid rays{"Set a smaller freedom.ray_range, or a larger freedom.sub_voxel_size."};
};

/// Steps 1, 3 and the first part of 4. They do not depend on any other scan.
void look(const Scan& scan, const DepthView& view, const Parameters& parameters,
          const RunContext& context, ScanWork& work) {
  work.scan = scan.index;
  work.rays.clear();
  {
    const StageScope timed(context.times, "voxels");
    work.voxels.fill(scan, parameters);
  }
  std::vector<Eigen::Vector3d> hole_ends;
  {
    const StageScope timed(context.times, "enhancement");
    if (parameters.enhancement) hole_ends = find_hole_ends(scan, view);
  }
  const StageScope timed(context.times, "raycasting");
  cast_rays(scan, work.voxels, hole_ends, parameters, work.rays, context);
}

/// Steps 2, the second part of 4, 5 and 6.
void take_in(ScanWork& work, const RunContext& context, FreeMap& free_space, StaticMap& points) {
  {
    const StageScope timed(context.times, "scan removal");
    free_space.count_hits(work.voxels);
    work.voxels.grow();
  }
  std::vector<VoxelIndex> newly_free;
  {
    const StageScope timed(context.times, "free space");
    newly_free = free_space.count_passes(work.rays);
  }
  {
    const StageScope timed(context.times, "map removal");
    points.remove(newly_free);
  }
  const StageScope timed(context.times, "integration");
  points.integrate(work.voxels, work.scan);
}

/// Steps 1 to 6. @return the sub-voxels that are not in the map
CellSet build_map(const Parameters& parameters, const ScanSource& scans,
                  const RunContext& context) {
  const DepthView view = view_for(scans.sensor(), parameters.image_maximum);
  FreeMap free_space(parameters);
  StaticMap points;
  for_prepared_scans<ScanWork>(
      "freedom", "rays and maps", scans, context,
      [&](const Scan& scan, ScanWork& work, const RunContext& of_step) {
        look(scan, view, parameters, of_step, work);
      },
      [&](ScanWork& work, const RunContext& of_step) {
        take_in(work, of_step, free_space, points);
      });
  return points.removed();
}

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  const CellSet removed = build_map(parameters, scans, context);
  answer_scans("freedom, answers", scans, sink, context, [&](const Scan& scan) {  // Step 7.
    return mask_by_voxel(scan, parameters.sub_voxel_size, [&](const VoxelIndex& sub_voxel) {
      return removed.contains(voxel_key(sub_voxel));
    });
  });
}

}  // namespace

std::unique_ptr<Remover> make_freedom(const Parameters& parameters) {
  if (parameters.minimum_range >= parameters.maximum_range) {
    throw ConfigurationError(
        "freedom.minimum_range must be below freedom.maximum_range, else no point is left.");
  }
  return remover_from(parameters, run);
}

}  // namespace raymoval::freedom_method
