// SPDX-License-Identifier: MIT
#include "benchmark/picture/canvas/colours.h"

#include <algorithm>
#include <cmath>

namespace raymoval {
namespace {

/// The colour mixed with white (`share` above 0) or black (below 0).
Colour mixed(const Colour& colour, double share) {
  const double end = share > 0.0 ? 255.0 : 0.0;
  const auto mix = [&](std::uint8_t channel) {
    const double value = channel + (end - channel) * std::abs(share);
    return static_cast<std::uint8_t>(std::lround(value));
  };
  return {mix(colour.red), mix(colour.green), mix(colour.blue)};
}

}  // namespace

std::string colour_text(const Colour& colour) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string text = "#";
  for (const std::uint8_t channel : {colour.red, colour.green, colour.blue}) {
    text += kDigits[channel >> 4U];
    text += kDigits[channel & 15U];
  }
  return text;
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
    colours.push_back(mixed(kSeriesColours[i % kSeriesColours.size()], share));
  }
  return colours;
}

}  // namespace raymoval
