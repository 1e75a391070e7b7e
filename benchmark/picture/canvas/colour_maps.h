// SPDX-License-Identifier: MIT
#pragma once

#include "benchmark/picture/canvas/colours.h"

namespace raymoval {

/// From dark blue over green to yellow for 0 .. 1, even in lightness; after matplotlib's viridis.
Colour sequential_colour(double share);

/// From blue over white to vermillion for -1 .. 1.
Colour diverging_colour(double share);

/// From one colour to another for 0 .. 1.
Colour blended(const Colour& from, const Colour& to, double share);

}  // namespace raymoval
