// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/raymoval_plus/objects/objects.h"

namespace raymoval::raymoval_plus_method {

/// What speaks for it that each point of a scan moves, from 0 to 1: half of it is what was decided,
/// a quarter the `contradiction` of the point's voxel, and a quarter the dynamic share of its
/// object. Ground that stays counts as never seen through; for a point without an object, its voxel
/// counts twice.
/// @param decided verdicts after step 8
std::vector<float> evidence_of_points(const SegmentedScan& scan, const Verdicts& decided,
                                      const EvidenceMaps& maps);

}  // namespace raymoval::raymoval_plus_method
