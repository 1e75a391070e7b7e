// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "methods/raymoval_plus/objects/objects.h"

namespace raymoval::raymoval_plus_method {

/// The sentences of the codes that `reasons_for` gives.
std::vector<std::string> reason_sentences();

/// The code of what decided last on each point of a scan.
/// @param by_objects verdicts after steps 6 and 7
/// @param decided verdicts after step 8
std::vector<std::uint8_t> reasons_for(const SegmentedScan& scan, const EvidenceMaps& maps,
                                      const Verdicts& by_objects, const Verdicts& decided);

}  // namespace raymoval::raymoval_plus_method
