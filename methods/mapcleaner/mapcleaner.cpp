// SPDX-License-Identifier: MIT
// "MapCleaner"; the sections are those of mapcleaner.h.
#include "methods/mapcleaner/mapcleaner.h"

#include <cmath>

#include "core/parallel.h"
#include "methods/common/patchwork/ground_segmentation.h"
#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"
#include "methods/mapcleaner/terrain.h"
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

/// The position of a point relative to the terrain.
enum class Part : std::uint8_t {
  kGround,
  kBelow,      ///< Below the ground.
  kCandidate,  ///< Above the ground; may be dynamic.
  kOther,      ///< Without terrain; not judged.
};

/// Section 3 for a scan, by heights above the terrain: calls `take(i, part)` for its points, in
/// ranges of points on any thread.
template <class Take>
void split_points(const Parameters& parameters, const Scan& scan, const Terrain& terrain,
                  int threads, Take&& take) {
  parallel_chunks(threads, scan.size(), kPointsATask, [&](std::size_t begin, std::size_t end) {
    Terrain::Cursor cursor;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d world = world_point(scan, i);
      const double height = world.z() - terrain.height_at(world, cursor);
      take(i, std::isnan(height)                   ? Part::kOther
              : height > parameters.ground_height  ? Part::kCandidate
              : height < -parameters.ground_height ? Part::kBelow
                                                   : Part::kGround);
    }
  });
}

ThinnedPoints find_candidates(const Parameters& parameters, const ScanSource& scans,
                              const Terrain& terrain, const RunContext& context) {
  ThinnedPoints voxels(parameters.voxel_size);
  std::vector<Part> parts;
  for_each_scan("mapcleaner, candidates", scans, context, [&](const Scan& scan) {
    const StageScope timed(context.times, "candidates");
    parts.resize(scan.size());
    split_points(parameters, scan, terrain, context.threads,
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

void answer(const Parameters& parameters, const ScanSource& scans, const Terrain& terrain,
            const ThinnedPoints& voxels, const VoxelVotes& votes, RemovalSink& sink,
            const RunContext& context) {
  const auto is_removed = [&](const Scan& scan, std::size_t i, Part part) {
    if (part == Part::kBelow) return parameters.remove_below;
    if (part != Part::kCandidate) return false;
    const std::size_t voxel = voxels.find(world_point(scan, i));
    return voxel != ThinnedPoints::kNone && votes.is_dynamic(voxel);
  };
  for_scans_at_once("mapcleaner, answers", "answers", scans, context, [&](const Scan& scan) {
    // Several scans at once are timed as one pass.
    const StageScope timed(context.threads == 1 ? context.times : nullptr, "answers");
    Mask mask(scan.size());
    split_points(parameters, scan, terrain, 1,
                 [&](std::size_t i, Part part) { mask[i] = is_removed(scan, i, part) ? 1 : 0; });
    sink.accept(scan.index, mask);
  });
}

void run(const Parameters& given, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  const Parameters parameters = for_sensor(given, scans.sensor());
  const Terrain terrain = find_terrain(parameters, scans, context);
  const ThinnedPoints voxels = find_candidates(parameters, scans, terrain, context);
  const VoxelVotes votes = take_votes(parameters, scans, voxels, context);
  answer(parameters, scans, terrain, voxels, votes, sink, context);
}

}  // namespace

std::unique_ptr<Remover> make_mapcleaner(const Parameters& parameters) {
  return remover_from(parameters, run);
}

}  // namespace raymoval::mapcleaner_method
