// SPDX-License-Identifier: MIT
#pragma once

#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/evidence/evidence_maps.h"
#include "methods/raymoval_plus/objects/objects.h"
#include "methods/raymoval_plus/terrain/terrain.h"
#include "methods/remover.h"

namespace raymoval::raymoval_plus_method {

/// Steps 6 to 8 for all scans, from a terrain and a map of which nothing changes any more.
void answer_from_map(const Terrain& terrain, const EvidenceMaps& maps, const Parameters& parameters,
                     const ScanSource& scans, RemovalSink& sink, const RunContext& context);

/// Steps 6 to 8 for one scan, whose clusters are known and divided.
/// @param marked numbers of the clusters that a track marked
void answer(const SegmentedScan& scan, const std::vector<int>& marked, const EvidenceMaps& maps,
            const Parameters& parameters, RemovalSink& sink, const RunContext& context);

}  // namespace raymoval::raymoval_plus_method
