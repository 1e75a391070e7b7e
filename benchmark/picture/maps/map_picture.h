// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/picture/maps/top_down.h"
#include "benchmark/run/folder/kept_run.h"

namespace raymoval {

/// Which cells a picture shows, and how large.
struct MapPictureOptions {
  std::vector<std::string> only;    ///< Patterns of cells. If empty, all but the controls.
  std::optional<WorldWindow> crop;  ///< If empty, 30 m around the sensor's path.
  double resolution = 0.0;          ///< Metres per pixel. If 0, `panel_pixels` decides.
  int panel_pixels = 420;           ///< The longer side of a panel.
};

/// Draws maps seen from above: a row for each sequence and a column for each method, in the colours
/// of `outcome_colour`. If a cell has no result or no kept removals, its panel is hatched and says
/// why.
/// @throws UsageError if a pattern matches no cell, if no chosen cell has kept removals, or if no
///   point lies within the crop; DataError if data or removals have changed since the run;
///   Cancelled
Canvas map_picture(const KeptRun& run, const MapPictureOptions& options,
                   const OpenContext& context);

/// What the sensor has seen well: its path and 30 m around it.
WorldWindow window_around_way(const ScanSource& scans);

/// Refuses a crop without a point. @param around the way of the sensor, to choose another
[[noreturn]] void throw_empty_crop(const WorldWindow& crop, const WorldWindow& around);

}  // namespace raymoval
