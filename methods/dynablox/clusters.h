// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/dynablox/dynablox.h"
#include "methods/dynablox/voxels.h"

namespace raymoval::dynablox_method {

/// Points of a scan that move together, ascending.
using Cluster = std::vector<std::uint32_t>;

/// Steps 3 to 5: the clusters of a scan.
std::vector<Cluster> find_clusters(const ScanVoxels& scan, const BlockMap& map,
                                   const Parameters& parameters);

}  // namespace raymoval::dynablox_method
