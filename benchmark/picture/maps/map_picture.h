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
