// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/raymoval_plus/objects/objects.h"

namespace raymoval::raymoval_plus_method {

/// Finds the mixed clusters that are one thing: what many scans agree with in them stands on what
/// is dynamic. Who stops near the sensor is seen to have come by where his legs are, for scans saw
/// through there before, and none ever looked to where his head is. A wall or a pole stands beside
/// what is dynamic, and on the ground.
/// @param is_mixed 1 for each cluster in question
/// @returns 1 for each of these clusters that is one thing
std::vector<std::uint8_t> find_whole_things(const SegmentedScan& scan,
                                            const std::vector<std::uint8_t>& is_mixed,
                                            const EvidenceMap& map, const Parameters& parameters);

}  // namespace raymoval::raymoval_plus_method
