// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/raymoval_plus/objects/objects.h"

namespace raymoval::raymoval_plus_method {

/// Step 6: the points of mostly dynamic clusters that stay: somebody stands beside a pole, or an
/// arm rests on a heap, and is one cluster with it. At least twice `settled_scans` scans agree with
/// their voxels before the dynamic points of the cluster came or after these left, eight in ten of
/// those that could, and hardly any saw through.
/// @param may_last 1 for each cluster that is asked for such points
/// @return 1 for each of `high_points` that is one
std::vector<std::uint8_t> lasting_points(const SegmentedScan& scan, const EvidenceMap& map,
                                         const std::vector<std::uint8_t>& may_last,
                                         const Parameters& parameters);

}  // namespace raymoval::raymoval_plus_method
