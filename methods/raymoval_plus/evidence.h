// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan.h"
#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/parameters.h"
#include "methods/raymoval_plus/range_image.h"

namespace raymoval {

/// Asks a scan's range image about every voxel within its evidence range, and decides these anew.
void add_evidence(const RangeImage& image, const Pose& T_world_sensor,
                  const RaymovalPlusParameters& parameters, int threads, EvidenceMap& map);

/// What one scan adds to the evidence on a voxel. Scans come in order of time.
/// @param distance of the voxel from the sensor, metres
void count(Seen seen, double distance, const RaymovalPlusParameters& parameters,
           VoxelEvidence& evidence);

}  // namespace raymoval
