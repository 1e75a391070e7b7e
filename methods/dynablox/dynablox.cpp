// SPDX-License-Identifier: MIT
// "Dynablox"; the numbers are those of dynablox.h.
#include "methods/dynablox/dynablox.h"

#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "methods/common/answers.h"
#include "methods/common/remover_from.h"
#include "methods/dynablox/field.h"
#include "methods/dynablox/voxels.h"

namespace raymoval::dynablox_method {
namespace {

/// The state that is kept from scan to scan.
class Detector {
 public:
  Detector(const Parameters& parameters, const ScanSource& scans)
      : parameters_(parameters), free_space_(parameters), integrator_(parameters, scans.sensor()) {}

  /// Steps 1 to 7. @return which points move
  Mask detect(const Scan& scan, const RunContext& context) {
    {
      const StageScope timed(context.times, "voxels");
      find_voxels(scan, parameters_.voxel_size, voxels_);
    }
    Mask mask(scan.size(), 0);
    if (!parameters_.offline) {
      const StageScope timed(context.times, "clusters");
      for (const Cluster& cluster : find_clusters(voxels_, map_, parameters_)) {
        for (const std::uint32_t point : cluster) mask[point] = 1;
      }
    }
    free_space_.update(touched_, voxels_.hits, static_cast<std::int32_t>(scan.index), context,
                       map_);
    integrator_.integrate(scan, context, map_, touched_);
    return mask;
  }

  /// The points of a scan in ever-free voxels, at any range.
  [[nodiscard]] Mask ever_free_points(const Scan& scan) const {
    BlockFinder blocks(map_);
    return mask_by_voxel(scan, parameters_.voxel_size, [&](const VoxelIndex& voxel) {
      const Block* block = blocks.find(block_of(voxel));
      return block != nullptr && contains(block->ever_free, voxel);
    });
  }

 private:
  Parameters parameters_;
  BlockMap map_;
  FreeSpace free_space_;
  Integrator integrator_;
  ScanVoxels voxels_;            ///< Of the current scan.
  std::vector<Block*> touched_;  ///< By the rays of the last scan.
};

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  Detector detector(parameters, scans);
  for_each_scan("dynablox", scans, context, [&](const Scan& scan) {
    const Mask mask = detector.detect(scan, context);
    if (!parameters.offline) sink.accept(scan.index, mask);
  });
  if (!parameters.offline) return;
  answer_scans("dynablox, answers", scans, sink, context,
               [&](const Scan& scan) { return detector.ever_free_points(scan); });
}

}  // namespace

void find_voxels(const Scan& scan, double voxel_size, ScanVoxels& found) {
  found.voxels.clear();
  found.hits.clear();
  VoxelIndex last_at;
  BlockBits* last = nullptr;  // Consecutive points mostly share their block.
  for (const Eigen::Vector3f& point : scan.points) {
    const VoxelIndex voxel =
        voxel_index(scan.T_world_sensor * point.cast<double>(), 1.0 / voxel_size);
    const VoxelIndex at = block_of(voxel);
    if (last == nullptr || at != last_at) last = &found.hits.find_or_make(at);
    last_at = at;
    insert(voxel, *last);
    found.voxels.push_back(voxel);
  }
}

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
