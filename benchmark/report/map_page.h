// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/report/scene.h"

namespace raymoval {

/// A cleaned map as one HTML file that needs nothing else: the 3-D view of what was kept and what
/// was removed, and below it some lines of text.
/// @param scene of a `MapSceneBuilder`
std::string map_page(const Scene& scene, const std::string& title,
                     const std::vector<std::string>& lines);

}  // namespace raymoval
