// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/layout.h"

namespace raymoval {

/// Simulated scenes: each is generated into the cache unless it is there, and then read like a
/// recorded drive in SemanticKITTI layout.
Layout scenes_layout();

}  // namespace raymoval
