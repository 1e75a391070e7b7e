// SPDX-License-Identifier: MIT
#pragma once

#include "methods/raymoval/parameters.h"
#include "methods/raymoval/static_map.h"
#include "methods/remover.h"

namespace raymoval::raymoval_method {

/// The offline answer: tests every scan against the finished map, as many scans at a time as there
/// are threads. With a prior map a point is a candidate by section 3 of the paper (eqs 1-11); else
/// it is one iff its voxel is not in the map. Candidates are validated (eqs 12-15).
/// @param map its boxes are brought up to date, and nothing else is changed
void answer_from_map(StaticMap& map, const Parameters& parameters, const ScanSource& scans,
                     RemovalSink& sink, const RunContext& context);

}  // namespace raymoval::raymoval_method
