// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "benchmark/picture/maps/top_down.h"
#include "benchmark/run/folder/kept_run.h"

namespace raymoval {

struct OverviewOptions {
  std::optional<WorldWindow> crop;  ///< If empty, 20 m around the sensor's path.
  int panel_pixels = 860;           ///< The width of each of the two maps.
};

/// Shows in one picture, seen obliquely from above, what removal does: the map of all scans with
/// the trails of what moved, the map that a method left, and, at a larger scale, the place where it
/// removed most. Points more than 4 m above the sensor are left out, so that trees do not hide the
/// street.
/// @throws UsageError if no point lies within the crop; DataError if removals or data are missing
/// or have changed since the run; Cancelled
Canvas overview_picture(const KeptRun& run, const KeptCell& cell, const OverviewOptions& options,
                        const OpenContext& context);

}  // namespace raymoval
