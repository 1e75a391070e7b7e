// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "benchmark/picture/canvas/colours.h"

// cairo's own names for its types, so that its header is not needed here.
struct _cairo;
struct _cairo_surface;

namespace raymoval {

/// Frees what cairo made.
struct CairoRelease {
  void operator()(_cairo* context) const;
  void operator()(_cairo_surface* surface) const;
};

enum class Align { kLeft, kCentre, kRight };

/// A picture in memory, drawn by cairo. Pixels count from the upper left corner; parts outside the
/// picture are not drawn. Texts are UTF-8, in DejaVu Sans.
class Canvas {
 public:
  /// Makes a white picture. @throws UsageError if it would be larger than `kMostPixels`
  Canvas(int width, int height);

  /// 160 MB of memory.
  static constexpr long kMostPixels = 40'000'000;

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;
  [[nodiscard]] Colour at(int x, int y) const;

  void fill(int x, int y, int width, int height, const Colour& colour);
  /// Draws a border just inside the rectangle.
  void frame(int x, int y, int width, int height, const Colour& colour);
  /// Sets each pixel of a rectangle to `colour_at(column, row)`, counted from the rectangle's upper
  /// left corner. A pixel without a colour is not changed.
  void draw_pixels(int x, int y, int width, int height,
                   const std::function<std::optional<Colour>(int, int)>& colour_at);
  /// Draws diagonal stripes, which mark a panel without content.
  void hatch(int x, int y, int width, int height);
  /// @param y of the baseline
  /// @param size of the letters in pixels
  /// @throws ConfigurationError if there is no font
  void text(int x, int y, const std::string& text, int size, const Colour& colour,
            Align align = Align::kLeft);

  /// The width of a text in pixels.
  [[nodiscard]] int text_width(const std::string& text, int size) const;
  /// `text`, or the longest beginning of it that fits into `width` with "..." at its end.
  [[nodiscard]] std::string fitted(const std::string& text, int size, int width) const;

  /// The picture as a PNG file's content. The same pixels give the same bytes.
  [[nodiscard]] std::string png_bytes() const;

 private:
  [[nodiscard]] _cairo* context() const { return context_.get(); }

  std::unique_ptr<_cairo_surface, CairoRelease> surface_;
  std::unique_ptr<_cairo, CairoRelease> context_;
};

inline constexpr Colour kInk{26, 26, 26};
inline constexpr Colour kSoftInk{89, 89, 89};
inline constexpr Colour kPaper{255, 255, 255};
inline constexpr Colour kBorder{200, 200, 200};

}  // namespace raymoval
