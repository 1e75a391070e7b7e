// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"
#include "methods/octomap/parameters.h"

namespace raymoval {
namespace octomap_method {

/// Occupancy mapping after Hornung et al., "OctoMap: an efficient probabilistic 3D mapping
/// framework based on octrees" (Autonomous Robots 34, 2013), on liboctomap's own tree, as a way to
/// remove moving objects: a point goes if its leaf is free once all scans are in.
///
/// Decisions and deviations are the `notes` of the entry.
/// @throws ConfigurationError if two parameters contradict each other
std::unique_ptr<Remover> make_octomap(const Parameters& parameters);

}  // namespace octomap_method

MethodEntry octomap_entry();

}  // namespace raymoval
