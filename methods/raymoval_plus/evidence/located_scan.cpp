// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/evidence/located_scan.h"

#include "core/parallel.h"

namespace raymoval::raymoval_plus_method {
namespace {

LocatedScan with_heights(WorldScan world, const Terrain& terrain, const RunContext& context) {
  std::vector<float> height = terrain.heights(world.points, context);
  std::vector<std::uint32_t> voxel(height.size(), EvidenceMap::kNone);
  return {std::move(world), std::move(height), std::move(voxel)};
}

bool is_ground(float height, const Parameters& parameters) {
  return height < static_cast<float>(parameters.ground_height);
}

}  // namespace

WorldScan to_world(Scan scan, const RunContext& context) {
  WorldScan world{std::move(scan), {}};
  world.points.resize(world.scan.size());
  parallel_for(context.threads, world.points.size(), kPointsATask, [&](std::size_t k) {
    world.points[k] = world.scan.T_world_sensor * world.scan.points[k].cast<double>();
  });
  return world;
}

LocatedScan add_to_map(WorldScan world, const Terrain& terrain, const Parameters& parameters,
                       const RunContext& context, EvidenceMap& map) {
  const StageScope timed(context.times, "voxels");
  LocatedScan located = with_heights(std::move(world), terrain, context);
  EvidenceMap::Blocks::Cursor cursor;
  for (std::size_t k = 0; k < located.points.size(); ++k) {
    if (is_ground(located.height[k], parameters)) continue;
    located.voxel[k] = map.add(located.points[k], cursor);
  }
  return located;
}

LocatedScan locate(WorldScan world, const Terrain& terrain, const EvidenceMap& map,
                   const Parameters& parameters, const RunContext& context) {
  const StageScope timed(context.times, "verdicts");
  LocatedScan located = with_heights(std::move(world), terrain, context);
  const std::size_t points = located.points.size();
  parallel_chunks(context.threads, points, kPointsATask, [&](std::size_t begin, std::size_t end) {
    EvidenceMap::Blocks::Cursor cursor;
    for (std::size_t k = begin; k < end; ++k) {
      if (is_ground(located.height[k], parameters)) continue;
      located.voxel[k] = map.find(located.points[k], cursor);
    }
  });
  return located;
}

}  // namespace raymoval::raymoval_plus_method
