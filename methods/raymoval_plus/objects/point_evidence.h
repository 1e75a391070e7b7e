// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/raymoval_plus/objects/objects.h"

namespace raymoval::raymoval_plus_method {

/// From 0 to 1: the scans that saw through a voxel against those that its number of agreeing scans
/// asks for, or those in a row before or after all that agree, if that is more. One half is where
/// step 4 would begin to call the voxel dynamic if it heard all of these scans. It does not hear
/// those that pass beside the voxel's points, which count here all the same.
float free_share(const VoxelEvidence& evidence, const Parameters& parameters);

/// What speaks for it that each point of a scan moves, from 0 to 1: half of it is what was decided,
/// a quarter the `free_share` of the point's voxel, and a quarter the dynamic share of its object.
/// Ground that stays counts as never seen through; for a point without an object, its voxel counts
/// twice.
/// @param decided verdicts after step 8
std::vector<float> evidence_of_points(const SegmentedScan& scan, const Verdicts& decided,
                                      const EvidenceMaps& maps, const Parameters& parameters);

}  // namespace raymoval::raymoval_plus_method
