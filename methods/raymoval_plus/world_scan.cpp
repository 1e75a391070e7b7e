// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/world_scan.h"

#include "core/parallel.h"

namespace raymoval {
namespace {

constexpr std::size_t kGrain = 8192;  // Points.

}  // namespace

std::vector<std::string> reason_sentences() {
  return {"no scan, or too few, saw through its voxel",
          "it is ground",
          "scans saw through its voxel, more than agree with it allow",
          "most of the decided voxels around its own were seen through",
          "its voxel was seen through, but few of the voxels around it were",
          "it belongs to an object that was seen moving or is mostly seen through",
          "it belongs to an object that hardly anything was seen through",
          "what stands above it moved",
          "what stands above it stays"};
}

WorldScan in_world(Scan scan, int threads) {
  WorldScan world;
  world.points.resize(scan.size());
  parallel_for(threads, scan.size(), kGrain, [&](std::size_t k) {
    world.points[k] = scan.T_world_sensor * scan.points[k].cast<double>();
  });
  world.scan = std::move(scan);
  return world;
}

void measure_heights(const Terrain& terrain, const RaymovalPlusParameters& parameters, int threads,
                     WorldScan& world) {
  world.height.assign(world.points.size(), std::numeric_limits<float>::infinity());
  if (!parameters.terrain) return;
  parallel_chunks(threads, world.points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Terrain::Heights::Cursor cursor;
    for (std::size_t k = begin; k < end; ++k) {
      world.height[k] = terrain.height(world.points[k], cursor);
    }
  });
}

void add_to_map(const RaymovalPlusParameters& parameters, WorldScan& world, EvidenceMap& map) {
  EvidenceMap::Blocks::Cursor cursor;
  world.voxel.assign(world.points.size(), EvidenceMap::kNone);
  for (std::size_t k = 0; k < world.points.size(); ++k) {
    if (is_ground(world.height[k], parameters)) continue;
    world.voxel[k] = map.add(world.points[k], cursor);
  }
}

void take_verdicts(const EvidenceMap& map, const RaymovalPlusParameters& parameters, int threads,
                   WorldScan& world) {
  world.voxel.resize(world.points.size());
  world.verdict.resize(world.points.size());
  parallel_chunks(threads, world.points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    EvidenceMap::Blocks::Cursor cursor;
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t voxel = is_ground(world.height[k], parameters)
                                      ? EvidenceMap::kNone
                                      : map.find(world.points[k], cursor);
      world.voxel[k] = voxel;
      // Ground has no voxel; nor has what was ground when its scan was added, and then was not.
      world.verdict[k] = voxel == EvidenceMap::kNone ? Evidence::kStatic : map.verdict(voxel);
    }
  });
}

Mask removed_points(const WorldScan& world) {
  Mask removed(world.verdict.size());
  for (std::size_t k = 0; k < removed.size(); ++k) {
    removed[k] = world.verdict[k] == Evidence::kDynamic ? 1 : 0;
  }
  return removed;
}

}  // namespace raymoval
