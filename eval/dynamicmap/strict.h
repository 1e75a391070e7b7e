// SPDX-License-Identifier: MIT
#pragma once

#include "eval/protocol.h"

namespace raymoval {

/// SA, DA, AA and HA over sets of cells. There is no search, so nothing depends on a neighbour, an
/// order or a tie.
///
/// The truth of the `dynamicmap` protocol, as two sets of cells on the lattice anchored at the
/// world origin: cells with a static point and cells with a dynamic point (a cell may be in both).
/// A static cell is preserved if a static point in it is kept, a dynamic one is cleared if no
/// dynamic point in it is kept. So the oracle has SA 100 and DA 100, and neither a neighbour within
/// reach nor a kept point of the other class helps. A cleaned cloud keeps the points that lie
/// within 0.05 m of it.
///
/// Counts: static_voxels, dynamic_voxels, preserved_static, remaining_dynamic; mixed_voxels, which
/// are in both sets; ego_points, out_of_range_points, ignored_points.
ProtocolEntry strict_protocol_entry();

}  // namespace raymoval
