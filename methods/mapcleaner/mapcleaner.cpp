// SPDX-License-Identifier: MIT
// "MapCleaner"; the sections are those of mapcleaner.h.
#include "methods/mapcleaner/mapcleaner.h"

#include <algorithm>
#include <optional>

#include "core/parallel.h"
#include "methods/common/patchwork/ground_segmentation.h"
#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/mapcleaner/sensor_settings.h"
#include "methods/mapcleaner/split.h"
#include "methods/mapcleaner/votes.h"

namespace raymoval::mapcleaner_method {
namespace {

constexpr std::size_t kPointsATask = 8192;

Eigen::Vector3d world_point(const Scan& scan, std::size_t i) {
  return scan.T_world_sensor * scan.points[i].cast<double>();
}

/// Sections 1 and 2.
Terrain find_terrain(const Parameters& parameters, const ScanSource& scans,
                     const RunContext& context) {
  patchwork::GroundSegmentation segmentation(parameters);
  Terrain terrain(parameters);
  for_each_scan("mapcleaner, ground", scans, context, [&](const Scan& scan) {
    const StageScope timed(context.times, "ground");
    terrain.add(scan, segmentation.find_ground(scan, context.threads));
  });
  terrain.finish(context);
  return terrain;
}

/// Which points of a scan are ground, found once more in each pass where the split needs it: that
/// takes time instead of memory for all points.
class GroundAgain {
 public:
  GroundAgain(const Parameters& parameters, const Split& split) {
    if (split.needs_ground()) segmentation_.emplace(parameters);
  }
  [[nodiscard]] bool is_needed() const { return segmentation_.has_value(); }
  /// Scans are to be given in order. @return one value per point, 1 = ground; empty if not needed
  Mask of(const Scan& scan, int threads) {
    return segmentation_ ? segmentation_->find_ground(scan, threads) : Mask();
  }

 private:
  std::optional<patchwork::GroundSegmentation> segmentation_;
};

/// Section 3 for a scan: calls `take(i, part)` for its points, in ranges of them on any thread.
template <class Take>
void split_points(const Scan& scan, const Mask& ground, const Split& split, int threads,
                  Take&& take) {
  parallel_chunks(threads, scan.size(), kPointsATask, [&](std::size_t begin, std::size_t end) {
    Terrain::Cursor cursor;
    for (std::size_t i = begin; i < end; ++i) {
      const bool is_ground = !ground.empty() && ground[i] != 0;
      take(i, split.part_of(world_point(scan, i), is_ground, cursor));
    }
  });
}

ThinnedPoints find_candidates(const Parameters& parameters, const ScanSource& scans,
                              const Split& split, const RunContext& context) {
  ThinnedPoints voxels(parameters.voxel_size);
  GroundAgain ground(parameters, split);
  std::vector<Part> parts;
  for_each_scan("mapcleaner, candidates", scans, context, [&](const Scan& scan) {
    const StageScope timed(context.times, "candidates");
    parts.resize(scan.size());
    split_points(scan, ground.of(scan, context.threads), split, context.threads,
                 [&](std::size_t i, Part part) { parts[i] = part; });
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i] == Part::kCandidate) voxels.add(world_point(scan, i));
    }
  });
  return voxels;
}

/// Section 4.
VoxelVotes take_votes(const Parameters& parameters, const ScanSource& scans,
                      const ThinnedPoints& voxels, const RunContext& context) {
  VoxelVotes votes(parameters, voxels, scans.sensor());
  for_each_scan("mapcleaner, votes", scans, context, [&](const Scan& scan) {
    const StageScope timed(context.times, "votes");
    votes.add(scan, context);
  });
  return votes;
}

void answer(const Parameters& parameters, const ScanSource& scans, const Split& split,
            const ThinnedPoints& voxels, const VoxelVotes& votes, RemovalSink& sink,
            const RunContext& context) {
  GroundAgain ground(parameters, split);
  const auto is_removed = [&](const Scan& scan, std::size_t i, Part part) {
    if (part == Part::kBelow) return parameters.remove_below;
    if (part == Part::kOther) return parameters.remove_other;
    if (part != Part::kCandidate) return false;
    const std::size_t voxel = voxels.find(world_point(scan, i));
    return voxel != ThinnedPoints::kNone && votes.is_dynamic(voxel);
  };
  const auto answer_scan = [&](const Scan& scan, int threads) {
    // Several scans at once are timed as one pass.
    const bool is_alone = ground.is_needed() || context.threads == 1;
    const StageScope timed(is_alone ? context.times : nullptr, "answers");
    Mask mask(scan.size());
    split_points(scan, ground.of(scan, threads), split, threads,
                 [&](std::size_t i, Part part) { mask[i] = is_removed(scan, i, part) ? 1 : 0; });
    sink.accept(scan.index, mask);
  };
  if (!ground.is_needed()) {
    for_scans_at_once("mapcleaner, answers", "answers", scans, context,
                      [&](const Scan& scan) { answer_scan(scan, 1); });
    return;
  }
  for_each_scan("mapcleaner, answers", scans, context,
                [&](const Scan& scan) { answer_scan(scan, context.threads); });
}

void run(const Parameters& given, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  const Parameters parameters = for_sensor(given, scans.sensor());
  const Terrain terrain = find_terrain(parameters, scans, context);
  const Split split(parameters, terrain);
  const ThinnedPoints voxels = find_candidates(parameters, scans, split, context);
  const VoxelVotes votes = take_votes(parameters, scans, voxels, context);
  answer(parameters, scans, split, voxels, votes, sink, context);
}

}  // namespace

std::unique_ptr<Remover> make_mapcleaner(const Parameters& parameters) {
  return remover_from(parameters, run);
}

}  // namespace raymoval::mapcleaner_method
