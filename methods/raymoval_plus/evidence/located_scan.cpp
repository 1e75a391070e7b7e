// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/located_scan.h"

#include <limits>

#include "core/parallel.h"

namespace raymoval::raymoval_plus_method {
namespace {

bool is_ground(float height, const Parameters& parameters) {
  return height < static_cast<float>(parameters.ground_height);
}

}  // namespace

void find_terrain_cells(const Terrain& terrain, const Parameters& parameters,
                        const RunContext& context, LocatedScan& scan) {
  if (!parameters.terrain) return;
  const StageScope timed(context.times, "terrain");
  terrain.find_cells_of(scan.scan, context.threads, scan.in_terrain);
}

void find_heights_and_cells(const Terrain& terrain, const EvidenceMap& map,
                            const Parameters& parameters, const RunContext& context,
                            LocatedScan& scan) {
  const StageScope timed(context.times, "heights and cells");
  if (parameters.terrain) {
    terrain.find_heights(scan.in_terrain, context, scan.height);
  } else {
    scan.height.assign(scan.scan.size(), std::numeric_limits<float>::infinity());
  }
  map.find_cells_of(scan.scan, context.threads, scan.in_map);
}

void add_to_map(const Parameters& parameters, const RunContext& context, LocatedScan& scan,
                EvidenceMap& map) {
  const StageScope timed(context.times, "voxels");
  scan.voxel.assign(scan.scan.size(), EvidenceMap::kNone);
  EvidenceMap::Adding adding;
  for (std::size_t k = 0; k < scan.voxel.size(); ++k) {
    if (is_ground(scan.height[k], parameters)) continue;
    scan.voxel[k] = map.add(scan.in_map[k], scan.in_map.parts[k], adding);
  }
}

void look_up(const EvidenceMap& map, const Parameters& parameters, const RunContext& context,
             LocatedScan& scan) {
  const StageScope timed(context.times, "verdicts");
  const std::size_t points = scan.scan.size();
  scan.voxel.assign(points, EvidenceMap::kNone);
  scan.verdict.assign(points, Verdict::kStatic);
  parallel_chunks(context.threads, points, kPointsATask, [&](std::size_t begin, std::size_t end) {
    EvidenceMap::Blocks::Cursor cursor;
    for (std::size_t k = begin; k < end; ++k) {
      if (is_ground(scan.height[k], parameters)) continue;
      const EvidenceMap::Found found = map.find(scan.in_map[k], cursor);
      if (found.voxel == EvidenceMap::kNone) continue;
      scan.voxel[k] = found.voxel;
      scan.verdict[k] = found.verdict;
    }
  });
}

void look_up_verdicts(const EvidenceMap& map, const RunContext& context, LocatedScan& scan) {
  const StageScope timed(context.times, "verdicts");
  scan.verdict.resize(scan.voxel.size());
  parallel_for(context.threads, scan.voxel.size(), kPointsATask, [&](std::size_t k) {
    const std::uint32_t voxel = scan.voxel[k];
    scan.verdict[k] = voxel == EvidenceMap::kNone ? Verdict::kStatic : map.verdict(voxel);
  });
}

}  // namespace raymoval::raymoval_plus_method
