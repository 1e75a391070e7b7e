// SPDX-License-Identifier: MIT
// "Remove, then Revert: Static Point cloud Map Construction using Multiresolution Range Images",
// Kim and Kim, IROS 2020. Decisions and their evidence: README.md.
#include "methods/removert/removert.h"

#include <algorithm>

#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/removert/map_points.h"
#include "methods/removert/scan_image.h"
#include "methods/removert/visibility.h"

namespace raymoval::removert_method {
namespace {

/// Remove, then revert.
class RemovertRun {
 public:
  RemovertRun(const Parameters& parameters, const ScanSource& scans, const RunContext& context)
      : parameters_(parameters),
        scans_(scans),
        context_(context),
        lattice_(parameters.map_voxel),
        // The points of a map that a pass must check.
        candidates_(parameters.difference == DifferenceRule::kAbsolute ? Candidates::kAll
                                                                       : Candidates::kInFront) {}

  void run(RemovalSink& sink) {
    MapPoints removed = remove(collect_map());
    // Revert: a removed point stays removed only if a scan flags it again in the map of removed
    // points.
    if (parameters_.revert_resolution_1 > 0.0) {
      removed = marked_points(removed, compare(removed, parameters_.revert_resolution_1), 1);
    }
    answer(removed, sink);
  }

 private:
  /// The merged and thinned scans.
  MapPoints collect_map() {
    MapBuilder builder(lattice_);
    for_each_scan("removert, map", scans_, context_, [&](const Scan& scan) {
      const StageScope stage(context_.times, "map");
      builder.add(scan.points, scan.T_world_sensor, context_.threads);
    });
    const StageScope stage(context_.times, "map");
    return builder.finish();
  }

  /// One pass per resolution, fine to coarse. @return the points of `map` that are flagged
  MapPoints remove(const MapPoints& map) {
    Mask flagged(map.size(), 0);
    for (const double resolution :
         {parameters_.remove_resolution_1, parameters_.remove_resolution_2,
          parameters_.remove_resolution_3}) {
      if (resolution == 0.0) continue;
      const bool updates = parameters_.update_between_passes;
      const Mask of_pass = compare(updates ? marked_points(map, flagged, 0) : map, resolution);
      auto next = of_pass.begin();
      for (std::uint8_t& flag : flagged) {
        if (!updates || flag == 0) flag = std::max(flag, *next++);
      }
    }
    return marked_points(map, flagged, 1);
  }

  /// 1 for each point of `map` that a scan flags.
  Mask compare(const MapPoints& map, double resolution) {
    const PixelGrid grid(parameters_, resolution);
    VisibilityPass pass(map, parameters_, candidates_);
    for_scans_in_parallel("removert, range images", scans_, all_scans(scans_), context_,
                          [&](const Scan& scan) {
                            const ScanImage image = image_of(scan, grid);
                            const StageScope stage(context_.times, "visibility");
                            pass.show(image, scan.T_world_sensor.inverse());
                          });
    return pass.flagged();
  }

  [[nodiscard]] ScanImage image_of(const Scan& scan, const PixelGrid& grid) const {
    const StageScope stage(context_.times, "scan image");
    return {scan.points, grid, parameters_, candidates_};
  }

  /// A point is removed iff its cell is.
  void answer(const MapPoints& removed, RemovalSink& sink) {
    VoxelSet cells;
    cells.reserve(removed.size());
    for (const Block& block : removed.blocks) {
      for (std::size_t i = block.begin; i < block.end; ++i) {
        cells.insert(voxel_key(lattice_.cell_index(block.key, removed.id[i])));
      }
    }
    for_scans_in_parallel(
        "removert, answers", scans_, all_scans(scans_), context_, [&](const Scan& scan) {
          const StageScope stage(context_.times, "answer");
          Mask mask(scan.size());
          for (std::size_t i = 0; i < mask.size(); ++i) {
            const auto place =
                lattice_.place_of(scan.T_world_sensor * scan.points[i].cast<double>());
            mask[i] = cells.contains(voxel_key(place.index)) ? 1 : 0;
          }
          sink.accept(scan.index, mask);
        });
  }

  const Parameters& parameters_;
  const ScanSource& scans_;
  const RunContext& context_;
  CellLattice lattice_;
  Candidates candidates_;
};

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  RemovertRun(parameters, scans, context).run(sink);
}

}  // namespace

std::unique_ptr<Remover> make_removert(const Parameters& parameters) {
  return remover_from(parameters, run);
}

}  // namespace raymoval::removert_method
