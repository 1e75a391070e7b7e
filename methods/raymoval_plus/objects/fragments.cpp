// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/fragments.h"

namespace raymoval::raymoval_plus_method {
namespace {

/// A fragment may be farther from an object, by this factor, than points of one cluster from each
/// other.
constexpr double kReach = 2.5;

}  // namespace

Fragments::Fragments(const SegmentedScan& scan, const Parameters& parameters) {
  for (std::size_t i = 0; i < scan.high_points.size(); ++i) {
    const Cluster& cluster = scan.clusters[static_cast<std::size_t>(scan.cluster_of[i])];
    if (!is_fragment(cluster.points, parameters)) continue;
    const std::uint32_t k = scan.high_points[i];
    const double range = scan.scan.points[k].cast<double>().norm();
    points_.push_back(
        {k, scan.world(k), kReach * (parameters.cluster_gap + parameters.cluster_growth * range)});
  }
}

}  // namespace raymoval::raymoval_plus_method
