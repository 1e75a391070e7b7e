// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/picture/canvas/colours.h"
#include "benchmark/picture/canvas/font.h"
#include "benchmark/picture/canvas/png_file.h"

namespace raymoval {

enum class Align { kLeft, kCentre, kRight };

/// A picture that is drawn on. Pixels from the upper left corner; what lies outside is left out.
class Canvas {
 public:
  /// A white one. @throws UsageError if it would be larger than `kMostPixels`
  Canvas(int width, int height);

  /// 120 MB of memory.
  static constexpr long kMostPixels = 40'000'000;

  [[nodiscard]] const RgbImage& image() const { return image_; }
  [[nodiscard]] int width() const { return image_.width; }
  [[nodiscard]] int height() const { return image_.height; }
  [[nodiscard]] Colour at(int x, int y) const;

  void set(int x, int y, const Colour& colour);
  void fill(int x, int y, int width, int height, const Colour& colour);
  /// A border just inside the rectangle.
  void frame(int x, int y, int width, int height, const Colour& colour);
  /// Diagonal stripes: a place where there is nothing to show.
  void hatch(int x, int y, int width, int height);
  /// @param y of the baseline
  void text(int x, int y, const std::string& text, int size, const Colour& colour,
            Align align = Align::kLeft);
  /// Several centred lines, broken between words; what does not fit is left out.
  void paragraph(int x, int y, int width, int height, const std::string& text, int size,
                 const Colour& colour);

  [[nodiscard]] const Font& font() const { return font_; }

 private:
  Font font_;
  RgbImage image_;
};

inline constexpr Colour kInk{26, 26, 26};
inline constexpr Colour kSoftInk{89, 89, 89};
inline constexpr Colour kPaper{255, 255, 255};
inline constexpr Colour kBorder{200, 200, 200};

}  // namespace raymoval
