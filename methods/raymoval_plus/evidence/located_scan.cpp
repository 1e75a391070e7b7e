// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/located_scan.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/parallel.h"

namespace raymoval::raymoval_plus_method {
namespace {

bool is_ground(float height, const Parameters& parameters) {
  return height < static_cast<float>(parameters.ground_height);
}

/// The points that are not ground among as many.
struct PointsAtOnce {
  std::array<std::size_t, kPointsAtOnce> point, slot;
  std::size_t count = 0;

  void add(std::size_t at, std::size_t its_slot) {
    point[count] = at;
    slot[count++] = its_slot;
  }
};

}  // namespace

void find_terrain_cells(const Terrain& terrain, const Parameters& parameters,
                        const RunContext& context, LocatedScan& scan) {
  if (!parameters.terrain) return;
  const StageScope timed(context.times, "terrain");
  terrain.find_cells_of(scan.scan, context.threads, scan.in_terrain);
}

void find_heights(const Terrain& terrain, const Parameters& parameters, const RunContext& context,
                  LocatedScan& scan) {
  const StageScope timed(context.times, "heights and cells");
  if (parameters.terrain) {
    terrain.find_heights(scan.in_terrain, context, scan.height);
  } else {
    scan.height.assign(scan.scan.size(), std::numeric_limits<float>::infinity());
  }
}

void find_heights_and_cells(const Terrain& terrain, const EvidenceMap& map,
                            const Parameters& parameters, const RunContext& context,
                            LocatedScan& scan) {
  find_heights(terrain, parameters, context, scan);
  const StageScope timed(context.times, "heights and cells");
  map.find_cells_of(scan.scan, context.threads, scan.in_map);
}

void add_to_map(const Parameters& parameters, const RunContext& context, LocatedScan& scan,
                EvidenceMap& map) {
  const StageScope timed(context.times, "voxels");
  const std::size_t points = scan.scan.size();
  scan.voxel.assign(points, EvidenceMap::kNone);
  EvidenceMap::Blocks::Cursor cursor;
  PointsAtOnce some;
  for (std::size_t begin = 0; begin < points; begin += kPointsAtOnce) {
    some.count = 0;
    for (std::size_t k = begin; k < std::min(points, begin + kPointsAtOnce); ++k) {
      if (is_ground(scan.height[k], parameters)) continue;
      some.add(k, map.make_slot(scan.in_map[k], cursor));
      map.expect_slot(some.slot[some.count - 1]);
    }
    for (std::size_t i = 0; i < some.count; ++i) {
      const std::size_t k = some.point[i];
      scan.voxel[k] = map.make_voxel(scan.in_map[k], some.slot[i]);
      map.expect_sums(scan.voxel[k]);
    }
    for (std::size_t i = 0; i < some.count; ++i) {
      const std::size_t k = some.point[i];
      map.add_point(scan.voxel[k], scan.in_map.parts[k]);
    }
  }
}

void correct_voxels(const Parameters& parameters, const RunContext& context, LocatedScan& scan,
                    EvidenceMap& map) {
  const StageScope timed(context.times, "voxels");
  EvidenceMap::Blocks::Cursor cursor;
  for (std::size_t k = 0; k < scan.voxel.size(); ++k) {
    const bool was_ground = scan.voxel[k] == EvidenceMap::kNone;
    if (is_ground(scan.height[k], parameters)) {
      scan.voxel[k] = EvidenceMap::kNone;
    } else if (was_ground) {
      scan.voxel[k] = map.add(scan.in_map[k], scan.in_map.parts[k], cursor);
    }
  }
}

void look_up(const EvidenceMap& map, const Parameters& parameters, const RunContext& context,
             LocatedScan& scan) {
  const StageScope timed(context.times, "verdicts");
  const std::size_t points = scan.scan.size();
  scan.voxel.assign(points, EvidenceMap::kNone);
  scan.verdict.assign(points, Verdict::kStatic);
  const auto look_up_some = [&](std::size_t begin, std::size_t end,
                                EvidenceMap::Blocks::Cursor& cursor) {
    PointsAtOnce some;
    for (std::size_t k = begin; k < end; ++k) {
      if (is_ground(scan.height[k], parameters)) continue;
      const std::size_t slot = map.find_slot(scan.in_map[k], cursor);
      if (slot == EvidenceMap::Blocks::kNoSlot) continue;
      some.add(k, slot);
      map.expect_slot(slot);
    }
    for (std::size_t i = 0; i < some.count; ++i) {
      const std::size_t k = some.point[i];
      scan.voxel[k] = map.voxel_in(some.slot[i]);
      if (scan.voxel[k] == EvidenceMap::kNone) continue;
      scan.verdict[k] = map.verdict_in(some.slot[i]);
    }
  };
  parallel_chunks(context.threads, points, kPointsATask, [&](std::size_t begin, std::size_t end) {
    EvidenceMap::Blocks::Cursor cursor;
    for (std::size_t first = begin; first < end; first += kPointsAtOnce) {
      look_up_some(first, std::min(end, first + kPointsAtOnce), cursor);
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
