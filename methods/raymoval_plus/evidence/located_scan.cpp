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

/// Some points of a scan that have to do with the same map, and their slots in it.
struct PointsAtOnce {
  std::array<std::size_t, kPointsAtOnce> point, slot;
  std::size_t count = 0;

  void add(std::size_t at, std::size_t its_slot) {
    point[count] = at;
    slot[count++] = its_slot;
  }
};

/// What stands, for the functions below.
struct StandingPoints {
  static constexpr bool kIsGround = false;
  static std::vector<std::uint32_t>& voxels(LocatedScan& scan) { return scan.voxel; }
  static VoxelIndex cell(const LocatedScan& scan, std::size_t k) { return scan.in_map[k]; }
  static std::uint32_t parts(const LocatedScan& scan, std::size_t k) {
    return scan.in_map.parts[k];
  }
};

/// The ground, likewise.
struct GroundPoints {
  static constexpr bool kIsGround = true;
  static std::vector<std::uint32_t>& voxels(LocatedScan& scan) { return scan.ground_voxel; }
  static VoxelIndex cell(const LocatedScan& scan, std::size_t k) {
    return ground_cell(scan.in_map[k]);
  }
  static std::uint32_t parts(const LocatedScan& scan, std::size_t k) {
    return ground_parts(scan.in_map[k], scan.in_map.parts[k]);
  }
};

/// Adds those points from `begin` to before `end` that belong to the kind.
template <class Kind>
void add_some(std::size_t begin, std::size_t end, const Parameters& parameters, LocatedScan& scan,
              EvidenceMap& map, EvidenceMap::Blocks::Cursor& cursor) {
  PointsAtOnce some;
  for (std::size_t k = begin; k < end; ++k) {
    if (is_ground(scan.height[k], parameters) != Kind::kIsGround) continue;
    some.add(k, map.make_slot(Kind::cell(scan, k), cursor));
    map.expect_slot(some.slot[some.count - 1]);
  }
  for (std::size_t i = 0; i < some.count; ++i) {
    const std::size_t k = some.point[i];
    Kind::voxels(scan)[k] = map.make_voxel(Kind::cell(scan, k), some.slot[i]);
    map.expect_sums(Kind::voxels(scan)[k]);
  }
  for (std::size_t i = 0; i < some.count; ++i) {
    const std::size_t k = some.point[i];
    map.add_point(Kind::voxels(scan)[k], Kind::parts(scan, k));
    map.see_from(Kind::voxels(scan)[k], scan.scan.points[k].norm());
  }
}

/// Gives those points that belong to the kind a voxel of it, and takes it from the others.
template <class Kind>
void correct_some(const Parameters& parameters, LocatedScan& scan, EvidenceMap& map) {
  EvidenceMap::Blocks::Cursor cursor;
  std::vector<std::uint32_t>& voxels = Kind::voxels(scan);
  for (std::size_t k = 0; k < voxels.size(); ++k) {
    if (is_ground(scan.height[k], parameters) != Kind::kIsGround) {
      voxels[k] = EvidenceMap::kNone;
    } else if (voxels[k] == EvidenceMap::kNone) {
      voxels[k] = map.add(Kind::cell(scan, k), Kind::parts(scan, k), cursor);
      map.see_from(voxels[k], scan.scan.points[k].norm());
    }
  }
}

/// Looks those points from `begin` to before `end` up that belong to the kind.
template <class Kind>
void look_up_some(std::size_t begin, std::size_t end, const Parameters& parameters,
                  const EvidenceMap& map, LocatedScan& scan, EvidenceMap::Blocks::Cursor& cursor) {
  PointsAtOnce some;
  for (std::size_t k = begin; k < end; ++k) {
    if (is_ground(scan.height[k], parameters) != Kind::kIsGround) continue;
    const std::size_t slot = map.find_slot(Kind::cell(scan, k), cursor);
    if (slot == EvidenceMap::Blocks::kNoSlot) continue;
    some.add(k, slot);
    map.expect_slot(slot);
  }
  for (std::size_t i = 0; i < some.count; ++i) {
    const std::size_t k = some.point[i];
    Kind::voxels(scan)[k] = map.voxel_in(some.slot[i]);
    if (Kind::voxels(scan)[k] != EvidenceMap::kNone) scan.verdict[k] = map.verdict_in(some.slot[i]);
  }
}

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

void find_heights_and_cells(const Terrain& terrain, const EvidenceMaps& maps,
                            const Parameters& parameters, const RunContext& context,
                            LocatedScan& scan) {
  find_heights(terrain, parameters, context, scan);
  const StageScope timed(context.times, "heights and cells");
  maps.standing.find_cells_of(scan.scan, context.threads, scan.in_map);
}

void add_to_maps(const Parameters& parameters, const RunContext& context, LocatedScan& scan,
                 EvidenceMaps& maps) {
  const StageScope timed(context.times, "voxels");
  const std::size_t points = scan.scan.size();
  scan.voxel.assign(points, EvidenceMap::kNone);
  scan.ground_voxel.assign(points, EvidenceMap::kNone);
  EvidenceMap::Blocks::Cursor standing, ground;
  for (std::size_t begin = 0; begin < points; begin += kPointsAtOnce) {
    const std::size_t end = std::min(points, begin + kPointsAtOnce);
    add_some<StandingPoints>(begin, end, parameters, scan, maps.standing, standing);
    add_some<GroundPoints>(begin, end, parameters, scan, maps.ground, ground);
  }
  for (const BeamImage::Extension& extension : scan.extensions) {
    const std::size_t k = extension.point;
    if (scan.voxel[k] != EvidenceMap::kNone) {
      maps.standing.add_beside(scan.voxel[k], scan.in_map.parts[k], extension.offset);
    }
  }
}

void correct_voxels(const Parameters& parameters, const RunContext& context, LocatedScan& scan,
                    EvidenceMaps& maps) {
  const StageScope timed(context.times, "voxels");
  correct_some<StandingPoints>(parameters, scan, maps.standing);
  correct_some<GroundPoints>(parameters, scan, maps.ground);
}

void look_up(const EvidenceMaps& maps, const Parameters& parameters, const RunContext& context,
             LocatedScan& scan) {
  const StageScope timed(context.times, "verdicts");
  const std::size_t points = scan.scan.size();
  scan.voxel.assign(points, EvidenceMap::kNone);
  scan.ground_voxel.assign(points, EvidenceMap::kNone);
  scan.verdict.assign(points, Verdict::kStatic);
  parallel_chunks(context.threads, points, kPointsATask, [&](std::size_t begin, std::size_t end) {
    EvidenceMap::Blocks::Cursor standing, ground;
    for (std::size_t first = begin; first < end; first += kPointsAtOnce) {
      const std::size_t last = std::min(end, first + kPointsAtOnce);
      look_up_some<StandingPoints>(first, last, parameters, maps.standing, scan, standing);
      look_up_some<GroundPoints>(first, last, parameters, maps.ground, scan, ground);
    }
  });
}

void look_up_verdicts(const EvidenceMaps& maps, const RunContext& context, LocatedScan& scan) {
  const StageScope timed(context.times, "verdicts");
  scan.verdict.resize(scan.voxel.size());
  parallel_for(context.threads, scan.voxel.size(), kPointsATask, [&](std::size_t k) {
    if (scan.voxel[k] != EvidenceMap::kNone) {
      scan.verdict[k] = maps.standing.verdict(scan.voxel[k]);
    } else if (scan.ground_voxel[k] != EvidenceMap::kNone) {
      scan.verdict[k] = maps.ground.verdict(scan.ground_voxel[k]);
    } else {
      scan.verdict[k] = Verdict::kStatic;
    }
  });
}

}  // namespace raymoval::raymoval_plus_method
