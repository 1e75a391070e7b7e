// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan.h"
#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/parameters.h"
#include "methods/raymoval_plus/tracks.h"

namespace raymoval {

/// A scan in the world: positions, heights above the ground and what is thought of each point.
struct WorldScan {
  Scan scan;
  std::vector<Eigen::Vector3d> points;  ///< World frame, metres.
  std::vector<float> height;            ///< Above the ground, metres; infinite if unknown.
  std::vector<std::uint32_t> voxel;     ///< Number in the map, or `EvidenceMap::kNone` for ground.
  std::vector<Evidence> verdict;
};

/// The clusters of a scan's points that stand clear of the ground.
struct ScanObjects {
  std::vector<std::size_t> points;  ///< Of the scan, ascending.
  std::vector<int> number;          ///< Cluster of each of them.
  std::vector<int> size, dynamic;   ///< Points, and dynamic ones, of each cluster.
};

ScanObjects find_objects(const WorldScan& world, const RaymovalPlusParameters& parameters);

/// What tracks need of each cluster, in order of cluster numbers; clusters too small or too wide
/// to be followed have no points.
std::vector<ObjectSummary> summaries(const ScanObjects& objects, const WorldScan& world,
                                     const EvidenceMap& map,
                                     const RaymovalPlusParameters& parameters);

/// A cluster is one thing: mostly dynamic ones go as a whole, hardly dynamic ones stay but for
/// groups of dynamic points that hang together. Clusters with a mark from a track go.
void judge_objects(const ScanObjects& objects, const std::vector<std::uint8_t>& marks,
                   const RaymovalPlusParameters& parameters, WorldScan& world);

/// Points near the ground follow what stands above them.
void judge_low_points(const RaymovalPlusParameters& parameters, WorldScan& world);

}  // namespace raymoval
