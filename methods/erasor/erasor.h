// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/erasor/parameters.h"
#include "methods/method_entry.h"

namespace raymoval {
namespace erasor_method {

/// "ERASOR: Egocentric Ratio of Pseudo Occupancy-based Dynamic Object Removal for Static 3D Point
/// Cloud Map Building" (Lim, Hwang, Myung, RA-L 2021), written from its description.
///
/// The map of all scans is an evolving set of voxels. Each query scan cuts the map around it into
/// polar bins and compares the vertical extent of a bin with its own. Where the map reaches much
/// higher, the bin's map voxels above a fitted ground plane are taken out, and those in which the
/// query itself has a point are put back. A point is dynamic iff its voxel is out at the end.
///
/// What differs from the public program is listed in the entry's `notes`.
/// @throws ConfigurationError if the height window is empty or the ego radius leaves no range.
std::unique_ptr<Remover> make_erasor(const Parameters& parameters);

}  // namespace erasor_method

MethodEntry erasor_entry();

}  // namespace raymoval
