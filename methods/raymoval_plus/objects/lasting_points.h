// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/raymoval_plus/objects/objects.h"

namespace raymoval::raymoval_plus_method {

/// Step 6: the points of mostly dynamic clusters that stay: somebody stands beside a pole, and is
/// one cluster with it. `outlast` times as many scans agree with their voxels as with the dynamic
/// ones of the cluster, from `settled_scans` before these to as many after, on average, and hardly
/// any saw through.
/// @param may_last 1 for each cluster that is asked for such points
/// @return 1 for each of `high_points` that is one
std::vector<std::uint8_t> lasting_points(const SegmentedScan& scan, const EvidenceMap& map,
                                         const std::vector<std::uint8_t>& may_last,
                                         const Parameters& parameters);

}  // namespace raymoval::raymoval_plus_method
