// SPDX-License-Identifier: MIT
#include "benchmark/picture/colours.h"

namespace raymoval {

std::string colour_text(const Colour& colour) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string text = "#";
  for (const std::uint8_t channel : {colour.red, colour.green, colour.blue}) {
    text += kDigits[channel >> 4U];
    text += kDigits[channel & 15U];
  }
  return text;
}

}  // namespace raymoval
