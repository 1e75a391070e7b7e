// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan.h"
#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/parameters.h"
#include "methods/raymoval_plus/tracks.h"
#include "methods/raymoval_plus/world_scan.h"

namespace raymoval {

/// The clusters of a scan's points that stand clear of the ground.
struct ScanObjects {
  std::vector<std::size_t> points;  ///< Of the scan, ascending.
  std::vector<int> number;          ///< Cluster of each of them.
  std::vector<int> size, dynamic;   ///< Points, and dynamic ones, of each cluster.
  /// What stands against a wall is one cluster with it. Such a cluster is divided: the points of
  /// settled voxels keep its number, what is left makes clusters of its own.
  std::vector<std::uint8_t> is_part;            ///< By cluster: left over from another one.
  std::vector<std::uint8_t> is_hardly_dynamic;  ///< By cluster: it or what it is a part of.
};

ScanObjects find_objects(const WorldScan& world, const EvidenceMap& map,
                         const RaymovalPlusParameters& parameters);

/// What tracks need of the clusters, without those too small or too wide to be followed.
std::vector<ObjectSummary> summaries(const ScanObjects& objects, const WorldScan& world,
                                     const EvidenceMap& map,
                                     const RaymovalPlusParameters& parameters);

/// A cluster is one thing: mostly dynamic ones go as a whole, hardly dynamic ones stay but for
/// groups of dynamic points that hang together. Clusters marked by a track go.
void judge_objects(const ScanObjects& objects, const std::vector<int>& marked,
                   const RaymovalPlusParameters& parameters, WorldScan& world);

/// Points near the ground follow what stands above them.
void judge_low_points(const RaymovalPlusParameters& parameters, WorldScan& world);

}  // namespace raymoval
