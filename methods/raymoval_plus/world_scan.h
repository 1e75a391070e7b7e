// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scan/scan.h"
#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/parameters.h"
#include "methods/raymoval_plus/terrain.h"

namespace raymoval {

/// A scan in the world: positions, heights above the ground and what is thought of each point.
struct WorldScan {
  Scan scan;
  std::vector<Eigen::Vector3d> points;  ///< World frame, metres.
  std::vector<float> height;            ///< Above the ground, metres; infinite if unknown.
  std::vector<std::uint32_t> voxel;     ///< Number in the map, or `EvidenceMap::kNone` for ground.
  std::vector<Evidence> verdict;
  std::vector<std::uint8_t> reason;  ///< A `Reason` for each verdict; empty unless asked for.
};

/// What decided on a point last.
enum class Reason : std::uint8_t {
  kNothingSeen,
  kGround,
  kSeenThrough,
  kNeighboursRemove,
  kNeighboursKeep,
  kObjectRemoved,
  kObjectKept,
  kStandsOnRemoved,
  kStandsOnKept,
};
/// A sentence for each, in order.
std::vector<std::string> reason_sentences();

/// Positions only.
WorldScan in_world(Scan scan, int threads);

/// Heights above the ground.
void measure_heights(const Terrain& terrain, const RaymovalPlusParameters& parameters, int threads,
                     WorldScan& world);

[[nodiscard]] inline bool is_ground(float height, const RaymovalPlusParameters& parameters) {
  return parameters.terrain && height < static_cast<float>(parameters.ground_height);
}

/// Adds the points that are not ground to the map.
void add_to_map(const RaymovalPlusParameters& parameters, WorldScan& world, EvidenceMap& map);

/// Each point's voxel and the verdict on that; ground is static.
void take_verdicts(const EvidenceMap& map, const RaymovalPlusParameters& parameters, int threads,
                   WorldScan& world);

/// 1 for each dynamic point.
Mask removed_points(const WorldScan& world);

}  // namespace raymoval
