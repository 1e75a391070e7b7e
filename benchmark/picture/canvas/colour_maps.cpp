// SPDX-License-Identifier: MIT
#include "benchmark/picture/canvas/colour_maps.h"

#include <algorithm>
#include <array>

namespace raymoval {

Colour sequential_colour(double share) {
  static constexpr std::array<Colour, 9> kStops = {{{68, 1, 84},
                                                    {71, 44, 122},
                                                    {59, 81, 139},
                                                    {44, 113, 142},
                                                    {33, 144, 141},
                                                    {39, 173, 129},
                                                    {92, 200, 99},
                                                    {170, 220, 50},
                                                    {253, 231, 37}}};
  const double place = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  return blended(kStops[below], kStops[below + 1], place - static_cast<double>(below));
}

Colour diverging_colour(double share) {
  constexpr Colour kWhite{247, 247, 247};
  return share < 0.0 ? blended(kWhite, verdict_colours::kFalsePositive, -share)
                     : blended(kWhite, verdict_colours::kFalseNegative, share);
}

}  // namespace raymoval
