// SPDX-License-Identifier: MIT
#pragma once

#include "benchmark/picture/canvas/colours.h"

namespace raymoval {

/// The colour of a share from 0 (dark blue) over green to 1 (yellow). Its lightness grows evenly,
/// as that of matplotlib's viridis does.
Colour sequential_colour(double share);

/// The colour of a share from -1 (blue) over 0 (white) to 1 (vermillion).
Colour diverging_colour(double share);

}  // namespace raymoval
