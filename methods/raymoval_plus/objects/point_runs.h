// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "methods/raymoval_plus/objects/objects.h"

namespace raymoval::raymoval_plus_method {

/// Points of one cluster, or of fragments beside it, that follow each other in their scan.
struct PointRun {
  std::uint32_t first;
  std::uint16_t count;
  std::uint16_t object;  ///< Number of the cluster's summary among those of the scan.
};

/// Whether the points of an object are remembered, for the case that a track marks it. It is not
/// worth it for what is dynamic by itself, nor for what scans agree with for long, which few tracks
/// pass through, nor for more objects than a scan has numbers for.
/// @param objects of a scan, of which this is the one with the given number
bool is_remembered(const std::vector<ObjectSummary>& objects, std::size_t number,
                   const Parameters& parameters);

/// The points of the objects that are remembered, and those of the fragments beside them.
/// @param objects of the scan, from `summarise_objects`
std::vector<PointRun> remembered_points(const SegmentedScan& scan,
                                        const std::vector<ObjectSummary>& objects,
                                        const Parameters& parameters);

}  // namespace raymoval::raymoval_plus_method
