// SPDX-License-Identifier: MIT
#include "benchmark/picture/canvas/canvas.h"

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

RgbImage white_image(int width, int height) {
  const long pixels = static_cast<long>(width) * height;
  if (width < 1 || height < 1 || pixels > Canvas::kMostPixels) {
    throw UsageError("the picture would have " + std::to_string(width) + " x " +
                     std::to_string(height) + " pixels; at most " +
                     grouped_text(Canvas::kMostPixels) +
                     " are drawn. Choose fewer cells with --only, a coarser --resolution or a "
                     "smaller --crop.");
  }
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(pixels) * 3, 255)};
}

std::uint8_t mixed(std::uint8_t below, std::uint8_t above, unsigned coverage) {
  return static_cast<std::uint8_t>((below * (255U - coverage) + above * coverage + 127U) / 255U);
}

/// Words to lines no wider than `width`.
std::vector<std::string> broken(const Font& font, const std::string& text, int size, int width) {
  std::vector<std::string> lines;
  for (const std::string_view word : split_blanks(text)) {
    const std::string longer =
        lines.empty() ? std::string(word) : lines.back() + " " + std::string(word);
    if (!lines.empty() && font.width(longer, size) <= width) {
      lines.back() = longer;
    } else {
      lines.push_back(font.fitted(std::string(word), size, width));
    }
  }
  return lines;
}

}  // namespace

Canvas::Canvas(int width, int height) : image_(white_image(width, height)) {}

Colour Canvas::at(int x, int y) const {
  const auto place = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) +
                          static_cast<std::size_t>(x));
  return {image_.rgb[place], image_.rgb[place + 1], image_.rgb[place + 2]};
}

void Canvas::set(int x, int y, const Colour& colour) {
  if (x < 0 || y < 0 || x >= width() || y >= height()) return;
  const auto place = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) +
                          static_cast<std::size_t>(x));
  image_.rgb[place] = colour.red;
  image_.rgb[place + 1] = colour.green;
  image_.rgb[place + 2] = colour.blue;
}

void Canvas::fill(int x, int y, int wide, int high, const Colour& colour) {
  for (int row = std::max(0, y); row < std::min(height(), y + high); ++row) {
    for (int column = std::max(0, x); column < std::min(width(), x + wide); ++column) {
      set(column, row, colour);
    }
  }
}

void Canvas::frame(int x, int y, int wide, int high, const Colour& colour) {
  fill(x, y, wide, 1, colour);
  fill(x, y + high - 1, wide, 1, colour);
  fill(x, y, 1, high, colour);
  fill(x + wide - 1, y, 1, high, colour);
}

void Canvas::hatch(int x, int y, int wide, int high) {
  constexpr int kPeriod = 14;
  for (int row = 0; row < high; ++row) {
    for (int column = 0; column < wide; ++column) {
      const bool stripe = (row + column) % kPeriod < 3;
      set(x + column, y + row, stripe ? Colour{214, 214, 214} : Colour{246, 246, 246});
    }
  }
}

void Canvas::text(int x, int y, const std::string& text, int size, const Colour& colour,
                  Align align) {
  const TextBitmap bitmap = font_.draw(text, size);
  const int left = align == Align::kLeft     ? x
                   : align == Align::kCentre ? x - bitmap.width / 2
                                             : x - bitmap.width;
  for (int row = 0; row < bitmap.height; ++row) {
    for (int column = 0; column < bitmap.width; ++column) {
      const unsigned covered =
          bitmap.coverage[static_cast<std::size_t>(row * bitmap.width + column)];
      const int to_x = left + column, to_y = y - bitmap.baseline + row;
      if (covered == 0 || to_x < 0 || to_y < 0 || to_x >= width() || to_y >= height()) continue;
      const Colour below = at(to_x, to_y);
      set(to_x, to_y,
          {mixed(below.red, colour.red, covered), mixed(below.green, colour.green, covered),
           mixed(below.blue, colour.blue, covered)});
    }
  }
}

void Canvas::paragraph(int x, int y, int wide, int high, const std::string& text, int size,
                       const Colour& colour) {
  const int pitch = size * 4 / 3;
  std::vector<std::string> lines = broken(font_, text, size, wide);
  const auto most = static_cast<std::size_t>(std::max(1, high / pitch));
  if (lines.size() > most) {
    lines.resize(most);
    lines.back() += " ...";
  }
  const int total = pitch * static_cast<int>(lines.size());
  int widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, font_.width(line, size));
  // Plain ground below, so that the words can be read on a hatched one.
  const int top = y + (high - total) / 2;
  fill(x + (wide - widest) / 2 - 6, top - 4, widest + 12, total + 8, kPaper);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    this->text(x + wide / 2, top + pitch * static_cast<int>(i) + size, lines[i], size, colour,
               Align::kCentre);
  }
}

}  // namespace raymoval
