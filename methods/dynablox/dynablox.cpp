// SPDX-License-Identifier: MIT
// "Dynablox"; the numbers are those of dynablox.h.
#include "methods/dynablox/dynablox.h"

#include <limits>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/dynablox/clusters.h"
#include "methods/dynablox/free_space.h"
#include "methods/dynablox/integration.h"

namespace raymoval::dynablox_method {
namespace {

/// All that is kept from scan to scan.
class Detector {
 public:
  Detector(const Parameters& parameters, const ScanSource& scans)
      : parameters_(parameters), free_space_(parameters), integrator_(parameters, scans.sensor()) {}

  /// Steps 1 to 8. @return which points move
  Mask detect(const Scan& scan, const RunContext& context) {
    {
      const StageScope timed(context.times, "voxels");
      const bool all = parameters_.judged == Judged::kAll;
      find_voxels(scan, parameters_.voxel_size, all ? 0.0 : parameters_.min_range,
                  all ? std::numeric_limits<double>::infinity() : integrator_.max_range(), voxels_);
    }
    Mask mask(scan.size(), 0);
    if (!parameters_.offline) {
      const StageScope timed(context.times, "clusters");
      mark_clusters(scan, mask);
    }
    const auto number = static_cast<std::int32_t>(scan.index);
    free_space_.update(touched_, voxels_.hits, number, context, map_);
    integrator_.integrate(scan, context, map_, touched_);
    return mask;
  }

  [[nodiscard]] const BlockMap& map() const { return map_; }

 private:
  /// Steps 3 to 6.
  void mark_clusters(const Scan& scan, Mask& mask) {
    std::vector<Cluster> clusters = find_clusters(scan, voxels_, map_, parameters_);
    if (parameters_.min_track > 0) {
      follow_clusters(last_clusters_, parameters_.track_distance, clusters);
    }
    for (const Cluster& cluster : clusters) {
      if (cluster.track < parameters_.min_track) continue;
      for (const std::uint32_t point : cluster.points) mask[point] = 1;
    }
    last_clusters_ = std::move(clusters);
  }

  Parameters parameters_;
  BlockMap map_;
  FreeSpace free_space_;
  Integrator integrator_;
  ScanVoxels voxels_;                   ///< Of the present scan.
  std::vector<Block*> touched_;         ///< By the rays of the last scan.
  std::vector<Cluster> last_clusters_;  ///< Of the last scan.
};

/// The points of a scan in voxels that are ever free, whatever their range.
Mask ever_free_points(const Scan& scan, double voxel_size, const BlockMap& map) {
  Mask mask(scan.size());
  LastBlock<const BlockMap, const Block> blocks(map);
  for (std::size_t k = 0; k < scan.size(); ++k) {
    const VoxelIndex voxel =
        voxel_index(scan.T_world_sensor * scan.points[k].cast<double>(), 1.0 / voxel_size);
    const Block* block = blocks.find(block_of(voxel));
    mask[k] = block != nullptr && block->is_ever_free(voxel) ? 1 : 0;
  }
  return mask;
}

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  Detector detector(parameters, scans);
  for_each_scan("dynablox", scans, context, [&](const Scan& scan) {
    const Mask mask = detector.detect(scan, context);
    if (!parameters.offline) sink.accept(scan.index, mask);
  });
  if (!parameters.offline) return;
  for_scans_at_once("dynablox, answers", "answers", scans, context, [&](const Scan& scan) {
    const StageScope timed(context.threads > 1 ? nullptr : context.times, "answers");
    sink.accept(scan.index, ever_free_points(scan, parameters.voxel_size, detector.map()));
  });
}

}  // namespace

std::unique_ptr<Remover> make_dynablox(const Parameters& parameters) {
  if (!(parameters.min_range < parameters.max_range)) {
    throw ConfigurationError(
        "dynablox.min_range = " + number_text(parameters.min_range) +
        " is not below dynablox.max_range = " + number_text(parameters.max_range) +
        ", so nothing would be known to be free; raise max_range.");
  }
  if (!(parameters.truncation > parameters.occupied_below)) {
    throw ConfigurationError(
        "dynablox.truncation = " + number_text(parameters.truncation) +
        " is not above dynablox.occupied_below = " + number_text(parameters.occupied_below) +
        ", so no voxel would ever be free; raise truncation or lower "
        "occupied_below.");
  }
  return remover_from(parameters, run);
}

}  // namespace raymoval::dynablox_method
