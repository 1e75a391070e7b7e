// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"
#include "methods/octomap/parameters.h"

namespace raymoval {

/// Occupancy mapping after Hornung et al., "OctoMap: an efficient probabilistic 3D mapping
/// framework based on octrees" (Autonomous Robots 34, 2013), on liboctomap's own tree, as a way to
/// remove moving objects: a point goes if its leaf is free once all scans are in.
///
/// Decisions and deviations (the entry's notes list them too):
/// - The map is liboctomap's tree with the leaves of `insertPointCloud`, kept to cells in which
/// some
///   scan has a point: no other is asked for, and no cell depends on another. The cells of a scan
///   and the way through the tree are computed by faster code.
/// - The tree's centre lies at the first scan's origin, rounded to whole cells of the world
/// lattice.
/// - A point whose leaf is unknown stays; so does one outside the tree.
/// - Scans go in by increasing index; the answer depends on that order.
/// @throws ConfigurationError if two parameters contradict each other
std::unique_ptr<Remover> make_octomap(const OctomapParameters& parameters);

MethodEntry octomap_entry();

}  // namespace raymoval
