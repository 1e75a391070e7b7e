// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/dynablox/parameters.h"
#include "methods/method_entry.h"

namespace raymoval {
namespace dynablox_method {

/// L. Schmid, O. Andersson, A. Sulser, P. Pfreundschuh, R. Siegwart: "Dynablox: Real-time Detection
/// of Diverse Dynamic Objects in Complex Environments", RA-L 2023. What moves is what appears where
/// it was ever free. Of each scan, in turn:
///  1. Points take part, if asked for those within range only.
///  2. They are sorted into voxels; those in ever-free ones are seeds.
///  3. Seeds grow into clusters, and to the voxels with points beside them.
///  4. Clusters near each other are one.
///  5. Clusters that are too small or too large are none.
///  6. Clusters are followed from scan to scan.
///  7. Voxels that were free for a while, as their neighbours, become ever free; those that are
///     occupied for long cease to be.
///  8. The scan is taken into the distance field that tells which voxels are free.
/// Decisions and deviations from the public program: `notes` of the entry.
/// @throws ConfigurationError if the ranges leave nothing, or distances are cut off below what
/// counts as occupied
std::unique_ptr<Remover> make_dynablox(const Parameters& parameters);

}  // namespace dynablox_method

MethodEntry dynablox_entry();

}  // namespace raymoval
