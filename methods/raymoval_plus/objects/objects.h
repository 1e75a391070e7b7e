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
  ObjectEvidence evidence;
};

/// A scan with its clusters.
struct SegmentedScan : LocatedScan {
  std::vector<std::uint32_t> high_points;  ///< The points that were clustered, ascending.
  std::vector<int> cluster_of;             ///< The cluster of each of these.
  std::vector<Cluster> clusters;
};

/// Step 6: finds the clusters. The verdicts need not be known yet.
void find_clusters(const Parameters& parameters, const RunContext& context, SegmentedScan& scan);
/// Adds what is known of a voxel to the sums of an object that has some points in it.
void add_evidence_of(std::uint32_t voxel, std::uint32_t points, const EvidenceMap& map,
                     ObjectEvidence& sum);
/// Step 6: sums the evidence of the clusters' points.
void add_evidence_of_points(const EvidenceMap& map, SegmentedScan& scan);

/// What step 7 needs of the clusters. Clusters too small or too wide to be followed are left out.
std::vector<ObjectSummary> summarise_objects(const SegmentedScan& scan, const EvidenceMap& map,
                                             const Parameters& parameters,
                                             const RunContext& context);

/// Steps 6 and 7: the verdicts after each cluster was taken as one thing. Dynamic clusters and
/// those that a track marked are dynamic as a whole, clusters with next to no dynamic points are
/// static. Where a cluster joins what moves to what stands, the other thing keeps its own verdict.
/// Fragments go with what goes beside them.
/// @param marked numbers of the clusters that a track marked
Verdicts decide_objects(const SegmentedScan& scan, const std::vector<int>& marked,
                        const EvidenceMap& map, const Parameters& parameters,
                        const RunContext& context);

}  // namespace raymoval::raymoval_plus_method
