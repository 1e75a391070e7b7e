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

/// Refuses a crop without a point. @param around the window around the sensor's path, for the
/// message
[[noreturn]] void throw_empty_crop(const WorldWindow& crop, const WorldWindow& around);

struct OverviewOptions {
  std::optional<WorldWindow> crop;  ///< If empty, 20 m around the sensor's path.
  int panel_pixels = 860;           ///< The width of each of the two maps.
};

/// Shows the effect of a method in one picture, seen obliquely from above: the map of all scans
/// with the trails of moving objects, the cleaned map, and, at a larger scale, the place where the
/// method removed most moving points. Points more than 4 m above the sensor are left out, so that
/// trees do not hide the street.
/// @throws UsageError if no point lies within the crop; DataError if removals or data are missing
/// or have changed since the run; Cancelled
Canvas overview_picture(const KeptRun& run, const KeptCell& cell, const OverviewOptions& options,
                        const OpenContext& context);

}  // namespace raymoval
