// SPDX-License-Identifier: MIT
// "FreeDOM"; the steps are numbered in freedom.h.
#include "methods/freedom/freedom.h"

#include <algorithm>

#include "core/error.h"
#include "methods/common/prepared_scans.h"
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
    hole_ends = find_hole_ends(scan, view, parameters);
  }
  const StageScope timed(context.times, "raycasting");
  cast_rays(scan, work.voxels, hole_ends, parameters, work.rays, context);
}

/// What is known of the scans so far.
struct Maps {
  explicit Maps(const Parameters& parameters) : free_space(parameters), points(parameters) {}

  FreeMap free_space;
  StaticMap points;
};

/// Steps 2, the second part of 4, 5 and 6.
void take_in(ScanWork& work, const Growth& growth, const RunContext& context, Maps& maps) {
  {
    const StageScope timed(context.times, "scan removal");
    maps.free_space.take_hits(work.voxels);
    work.voxels.grow(growth);
  }
  std::vector<VoxelIndex> newly_free;
  {
    const StageScope timed(context.times, "free space");
    newly_free = maps.free_space.take_passes(work.rays);
  }
  {
    const StageScope timed(context.times, "map removal");
    maps.points.remove(newly_free);
  }
  const StageScope timed(context.times, "integration");
  maps.points.integrate(work.voxels, work.scan);
}

/// Steps 1 to 6. @return the sub-voxels that are not in the map
CellSet build_map(const Parameters& parameters, const ScanSource& scans,
                  const RunContext& context) {
  const DepthView view = view_for(scans.sensor(), parameters);
  const Growth growth = growth_of(parameters, false);
  Maps maps(parameters);
  for_prepared_scans<ScanWork>(
      "freedom", "rays and maps", scans, context,
      [&](const Scan& scan, ScanWork& work, const RunContext& of_step) {
        look(scan, view, parameters, of_step, work);
      },
      [&](ScanWork& work, const RunContext& of_step) { take_in(work, growth, of_step, maps); });
  return maps.points.removed();
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
  if (parameters.enhancement && parameters.image_minimum >= parameters.image_maximum) {
    throw ConfigurationError(
        "freedom.image_minimum must be below freedom.image_maximum, else no point is in the image; "
        "set freedom.enhancement=false to do without it.");
  }
  return remover_from(parameters, run);
}

}  // namespace raymoval::freedom_method
