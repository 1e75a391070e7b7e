// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"
#include "methods/removert/parameters.h"

namespace raymoval {
namespace removert_method {

/// The method of "Remove, then Revert: Static Point cloud Map Construction using Multiresolution
/// Range Images" (Kim and Kim, IROS 2020), written from its description; nothing of the public
/// code, whose licence forbids commercial use, is in it.
///
/// What was decided where the paper's programs disagree or are silent is listed in the entry's
/// `notes`. Of the map only centroids are held, at the peak about 75 bytes per cell of `map_voxel`;
/// scans are read once per pass.
std::unique_ptr<Remover> make_removert(const Parameters& parameters);

}  // namespace removert_method

MethodEntry removert_entry();

}  // namespace raymoval
