// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan.h"
#include "methods/raymoval_plus/evidence_map.h"
#include "methods/raymoval_plus/parameters.h"
#include "methods/raymoval_plus/range_image.h"

namespace raymoval {

/// Asks a scan's range image about every voxel within its evidence range, and decides these anew.
void add_evidence(const RangeImage& image, const Pose& T_world_sensor,
                  const RaymovalPlusParameters& parameters, int threads, EvidenceMap& map);

/// What one scan adds to the evidence on a voxel. Scans come in order of time.
/// @param distance of the voxel from the sensor, metres
inline void count(Seen seen, float distance, const RaymovalPlusParameters& parameters,
                  VoxelEvidence& evidence) {
  const auto count_up = [](std::uint16_t& count) {
    if (count < 0xFFFFU) ++count;
  };
  if (seen == Seen::kAgree) {
    count_up(evidence.agree_scans);
    evidence.trailing_free = 0;
  } else if (seen == Seen::kFree) {
    count_up(evidence.free_scans);
    if (distance > static_cast<float>(parameters.run_range)) return;
    count_up(evidence.trailing_free);
    if (evidence.agree_scans == 0) count_up(evidence.leading_free);
  }
}

/// Enough scans agree with a voxel, and none saw through it: it was there all the time.
inline bool was_always_there(const VoxelEvidence& evidence,
                             const RaymovalPlusParameters& parameters) {
  return parameters.settled_scans > 0 && evidence.free_scans == 0 &&
         evidence.agree_scans >= parameters.settled_scans;
}

/// Static, dynamic or undecided, from the numbers of scans that saw through and that agree.
inline Evidence decide(const VoxelEvidence& evidence, const RaymovalPlusParameters& parameters) {
  const double needed = parameters.free_constant + parameters.free_per_agree * evidence.agree_scans;
  const bool came_or_left =
      parameters.run_scans > 0 && (evidence.leading_free >= parameters.run_scans ||
                                   evidence.trailing_free >= parameters.run_scans);
  if (came_or_left || evidence.free_scans >= needed) return Evidence::kDynamic;
  return evidence.agree_scans >= parameters.static_agree ? Evidence::kStatic : Evidence::kUndecided;
}

}  // namespace raymoval
