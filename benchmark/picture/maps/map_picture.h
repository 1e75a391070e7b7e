// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/picture/canvas/png_file.h"
#include "benchmark/picture/maps/top_down.h"
#include "benchmark/run/kept_run.h"

namespace raymoval {

/// Which cells are shown and how large.
struct MapPictureOptions {
  std::vector<std::string> only;    ///< Patterns; without any, all methods that are no controls.
  std::optional<WorldWindow> crop;  ///< Without: 30 m about the sensor's way.
  double resolution = 0.0;          ///< Metres per pixel; 0: panels of `panel_pixels`.
  int panel_pixels = 420;           ///< Longer side of a panel.
};

/// Maps seen from above, a row for each sequence and a column for each method, in the colours of
/// `outcome_colour`. A cell without a result, or without kept removals, is a hatched panel that
/// says why.
/// @throws UsageError if a pattern fits no cell, or nothing that is chosen has kept removals;
///   DataError if data or removals are not what they were; Cancelled
RgbImage map_picture(const KeptRun& run, const MapPictureOptions& options,
                     const OpenContext& context);

/// What the sensor may have seen well: its way and 30 m around.
WorldWindow window_around_way(const ScanSource& scans);

}  // namespace raymoval
