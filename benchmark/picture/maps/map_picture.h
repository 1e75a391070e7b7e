// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/picture/maps/top_down.h"
#include "benchmark/run/folder/kept_run.h"

namespace raymoval {

/// The cells and the scale of a picture.
struct MapPictureOptions {
  std::vector<std::string> only;    ///< Patterns of cells. If empty, all but the controls.
  std::optional<WorldWindow> crop;  ///< If empty, 30 m around the sensor's path.
  double resolution = 0.0;          ///< Metres per pixel. If 0, `panel_pixels` decides.
  int panel_pixels = 420;           ///< The longer side of a panel.
};

/// Draws maps seen from above: a row for each sequence and a column for each method, in the colours
/// of `outcome_colour`. If a cell has no result or no kept removals, its panel is hatched and shows
/// the reason.
/// @throws UsageError if a pattern matches no cell, if no chosen cell has kept removals, or if no
///   point lies within the crop; DataError if data or removals have changed since the run;
///   Cancelled
Canvas map_picture(const KeptRun& run, const MapPictureOptions& options,
                   const OpenContext& context);

/// The area that the sensor has seen well: 30 m around its path.
WorldWindow window_around_way(const ScanSource& scans);

}  // namespace raymoval
