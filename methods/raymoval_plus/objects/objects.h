// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/evidence/located_scan.h"
#include "methods/raymoval_plus/objects/object_summary.h"

namespace raymoval::raymoval_plus_method {

using Verdicts = std::vector<Verdict>;  ///< One for each point of a scan.

/// A cluster of a scan's points that stand clear of the ground.
struct Cluster {
  int points = 0;
  int dynamic = 0;  ///< How many of these are dynamic.
  int firm = 0;
  float score = 0.0F, outside = 0.0F;
  /// What stands against a wall is one cluster with it. Such a cluster is divided: the points of
  /// voxels that many scans agree with stay in it, and the others make parts of their own.
  bool is_part = false;
  bool is_hardly_dynamic = false;  ///< The cluster, or the one that it is a part of, is.
  /// It is mixed, and what is not dynamic in it stands on what is: all of it is one dynamic thing.
  bool is_whole = false;
  /// It stands for a cluster as it was before it was divided. It is no point's own cluster.
  bool is_undivided = false;
  /// Of a cluster that was divided and of its parts: the number of the one that stands for all of
  /// them, if there is one. Otherwise -1.
  int undivided = -1;
};

/// A scan with its clusters.
struct SegmentedScan : LocatedScan {
  std::vector<std::uint32_t> high_points;  ///< The points that were clustered, ascending.
  std::vector<int> cluster_of;             ///< The cluster of each of these.
  std::vector<Cluster> clusters;
};

/// Calls `visit(number)` with the own cluster of the `n`th of the `high_points`, and with the one
/// that stands for what this was divided from.
template <class Visit>
void for_clusters_of(const SegmentedScan& scan, std::size_t n, Visit&& visit) {
  const auto own = static_cast<std::size_t>(scan.cluster_of[n]);
  visit(own);
  const int undivided = scan.clusters[own].undivided;
  if (undivided >= 0) visit(static_cast<std::size_t>(undivided));
}

/// Step 6: finds the clusters. The verdicts need not be known yet.
void find_clusters(const Parameters& parameters, const RunContext& context, SegmentedScan& scan);
/// Counts the points of the clusters, and what is dynamic in them.
void count_points(const EvidenceMap& map, SegmentedScan& scan);
/// Step 6: counts what is dynamic in the clusters, and divides those that are mixed. Of what was
/// divided a cluster more tells what it was.
void divide_clusters(const EvidenceMap& map, const Parameters& parameters,
                     const RunContext& context, SegmentedScan& scan);

/// What step 7 needs of the clusters. Those too small, too wide or too sparse to be followed are
/// left out.
/// @param steps of the sensor
std::vector<ObjectSummary> summarise_objects(const SegmentedScan& scan, const EvidenceMap& map,
                                             const DirectionSteps& steps,
                                             const Parameters& parameters,
                                             const RunContext& context);

/// Steps 6 and 7: the verdicts after each cluster was taken as one thing. Mostly dynamic ones and
/// those that a track marked are dynamic as a whole, except for what lasts in the former. Hardly
/// dynamic ones are static, except for groups of dynamic points that hang together. Fragments go
/// with what goes beside them.
/// @param marked numbers of the clusters that a track marked
Verdicts decide_objects(const SegmentedScan& scan, const EvidenceMap& map,
                        const std::vector<int>& marked, const Parameters& parameters,
                        const RunContext& context);

}  // namespace raymoval::raymoval_plus_method
