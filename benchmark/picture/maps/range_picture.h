// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "benchmark/picture/canvas/canvas.h"
#include "benchmark/run/folder/kept_run.h"

namespace raymoval {

struct RangePictureOptions {
  std::optional<long> frame;  ///< Number of the scan's frame; without: the middle scan.
  int width = 1200;           ///< Of the images, pixels.
};

/// Range images of one scan, one below the other, as the sensor sees them (left is left): the scan,
/// the first hit of the method's cleaned map (voxels of 0.2 m, all scans), map minus scan, and what
/// became of the points. A pixel of the scan is the nearest point in its direction.
/// @throws UsageError if there is no such frame; DataError if removals or data are missing or not
///   what they were; Cancelled
Canvas range_picture(const KeptRun& run, const KeptCell& cell, const RangePictureOptions& options,
                     const OpenContext& context);

}  // namespace raymoval
