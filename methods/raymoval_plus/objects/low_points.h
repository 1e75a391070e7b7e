// SPDX-License-Identifier: MIT
#pragma once

#include "methods/raymoval_plus/objects/objects.h"

namespace raymoval::raymoval_plus_method {

/// Step 8: lets the points near the ground follow what stands above them. Only what is dynamic
/// matters from here on: what is not may be static or undecided.
/// @param maps in which the scan's points were looked up
/// @param verdict of each point, from the steps before
void decide_low_points(const LocatedScan& scan, const EvidenceMaps& maps,
                       const Parameters& parameters, const RunContext& context, Verdicts& verdict);

}  // namespace raymoval::raymoval_plus_method
