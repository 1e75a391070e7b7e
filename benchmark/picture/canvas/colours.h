// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace raymoval {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;

  friend bool operator==(const Colour&, const Colour&) = default;
};

/// A mixture of two colours: `from` for a share of 0, `to` for a share of 1.
Colour blended(const Colour& from, const Colour& to, double share);

/// "#009E73".
std::string colour_text(const Colour& colour);

/// The colours of the verdicts on points, in every picture. They are from the palette of Okabe and
/// Ito, which colour-blind readers can distinguish. Kept static points are grey.
namespace verdict_colours {
inline constexpr Colour kTruePositive{0, 158, 115};   ///< Moving and removed: bluish green.
inline constexpr Colour kFalsePositive{0, 114, 178};  ///< Static and removed: blue.
inline constexpr Colour kFalseNegative{213, 94, 0};   ///< Moving and kept: vermillion.
inline constexpr Colour kKeptStatic{176, 176, 176};   ///< Static and kept: grey.
}  // namespace verdict_colours

/// The palette of Okabe and Ito without black and yellow, which are hard to see on a dark and on a
/// light background.
inline constexpr std::array<Colour, 6> kSeriesColours = {
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}}};

/// `count` different colours: those of the palette first, then lighter and darker ones of the same
/// hues.
std::vector<Colour> distinct_colours(std::size_t count);

}  // namespace raymoval
