// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "benchmark/picture/canvas/png_file.h"
#include "benchmark/picture/maps/top_down.h"
#include "benchmark/run/kept_run.h"

namespace raymoval {

struct OverviewOptions {
  std::optional<WorldWindow> crop;  ///< Without: the sensor's way and 20 m around.
  int panel_pixels = 860;           ///< Width of the two maps.
};

/// What removal is about in one picture, seen from a slope: the map of all scans with the trails of
/// what moved, the map that a method left, and the place where it removed most at a larger scale.
/// Points more than 4 m above the sensor are left out, so that trees do not hide the street.
/// @throws DataError if removals or data are missing or not what they were; Cancelled
RgbImage overview_picture(const KeptRun& run, const KeptCell& cell, const OverviewOptions& options,
                          const OpenContext& context);

}  // namespace raymoval
