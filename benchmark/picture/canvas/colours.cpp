// SPDX-License-Identifier: MIT
#include "benchmark/picture/canvas/colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raymoval {
Colour blended(const Colour& from, const Colour& to, double share) {
  const double weight = std::clamp(share, 0.0, 1.0);
  const auto channel = [&](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + weight * (static_cast<double>(b) - a)));
  };
  return {channel(from.red, to.red), channel(from.green, to.green), channel(from.blue, to.blue)};
}

std::string colour_text(const Colour& colour) {
  return fmt::format("#{:02X}{:02X}{:02X}", colour.red, colour.green, colour.blue);
}

std::vector<Colour> distinct_colours(std::size_t count) {
  std::vector<Colour> colours;
  const std::size_t rounds = (count + kSeriesColours.size() - 1) / kSeriesColours.size();
  for (std::size_t i = 0; i < count; ++i) {
    // Lighter and darker in turn, in as many steps as there are rounds; never white or black.
    const std::size_t round = i / kSeriesColours.size();
    const double step = static_cast<double>((round + 1) / 2) /
                        static_cast<double>(std::max<std::size_t>(1, rounds / 2));
    const double share = round == 0 ? 0.0 : (round % 2 == 1 ? 0.6 * step : -0.55 * step);
    const Colour end = share > 0.0 ? Colour{255, 255, 255} : Colour{0, 0, 0};
    colours.push_back(blended(kSeriesColours[i % kSeriesColours.size()], end, std::abs(share)));
  }
  return colours;
}

}  // namespace raymoval
