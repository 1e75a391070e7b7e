// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"
#include "methods/raymoval_plus/parameters.h"

namespace raymoval {

/// Removes what the rays of all scans contradict: terrain, three-way evidence of every scan on
/// every voxel, a vote, objects and their tracks. See README.md beside this file.
std::unique_ptr<Remover> make_raymoval_plus(const RaymovalPlusParameters& parameters);

MethodEntry raymoval_plus_entry();

}  // namespace raymoval
