// SPDX-License-Identifier: MIT
// "DUFOMap: Efficient Dynamic Awareness Mapping"; the steps are numbered in dufomap.h.
#include "methods/dufomap/dufomap.h"

#include "methods/common/answers.h"
#include "methods/common/prepared_scans.h"
#include "methods/common/remover_from.h"
#include "methods/dufomap/beams.h"

namespace raymoval::dufomap_method {
namespace {

/// Results of the steps for one scan; its memory is used again for later scans.
struct ScanWork {
  std::size_t scan = 0;
  std::vector<VoxelIndex> voxels;  ///< The voxel of each point.
  ScanGrid grid{"Set dufomap.maximum_range to bound beams, or a larger dufomap.voxel_size."};
  ScanVoids voids;
};

/// Steps 1 to 4. The result for a scan does not depend on any other scan.
void find_voids_of(const Scan& scan, const Parameters& parameters, const RunContext& context,
                   ScanWork& work) {
  work.scan = scan.index;
  work.grid.clear();
  std::vector<VoxelIndex> ends;
  {
    const StageScope timed(context.times, "binning");
    work.voxels = voxels_of(scan, parameters.voxel_size);
    ends = beam_ends(scan, work.voxels, parameters, work.grid);
  }
  {
    const StageScope timed(context.times, "raycasting");
    cast_beams(scan, ends, parameters, work.grid, context);
  }
  const StageScope timed(context.times, "voids");
  find_voids(work.grid, parameters.unknown_inflation, work.voids);
}

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  VoidMap voids;
  for_prepared_scans<ScanWork>(
      "dufomap", "beams and voids", scans, context,
      [&](const Scan& scan, ScanWork& work, const RunContext& here) {
        find_voids_of(scan, parameters, here, work);
      },
      [&](ScanWork& work, const RunContext& here) {  // Step 5, in order of time.
        const StageScope timed(here.times, "integration");
        voids.add(work.voids);
        if (!parameters.offline) sink.accept(work.scan, voids.contain(work.voxels));
      });
  if (!parameters.offline) return;
  answer_scans("dufomap, answers", scans, sink, context, [&](const Scan& scan) {
    return voids.contain(voxels_of(scan, parameters.voxel_size));
  });
}

}  // namespace

std::unique_ptr<Remover> make_dufomap(const Parameters& parameters) {
  return remover_from(parameters, run);
}

}  // namespace raymoval::dufomap_method
