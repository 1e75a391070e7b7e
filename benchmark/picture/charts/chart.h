// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/picture/canvas/colours.h"

namespace raymoval {

/// The look of a series of points. Series differ in both colour and shape, so that one of them is
/// enough to distinguish them.
struct SeriesStyle {
  Colour colour;
  int shape = 0;  ///< 0 .. 4: circle, square, diamond, triangle up, triangle down.
};
/// @param count of the series in the chart, each of which has a colour of its own
SeriesStyle series_style(std::size_t index, std::size_t count);

/// The charts' style as CSS. The colours of text, lines and ground are the custom properties
/// --chart-ink, --chart-soft, --chart-line and --chart-ground. They follow prefers-color-scheme; a
/// page with a switch between light and dark sets them itself. Programs without custom properties
/// use the light colours.
std::string chart_style();

/// In pixels, x to the right, y down.
struct ChartPoint {
  double x = 0.0, y = 0.0;
};

/// A chart, written as SVG. Lengths are rounded to hundredths.
class Chart {
 public:
  Chart() = default;  ///< No chart.
  /// Begins a chart with its title at the top.
  /// @param name distinguishes the chart's ids from those of other charts in a page
  Chart(const std::string& name, const std::string& title, const std::string& description);

  /// @param look classes: "ink", "soft" (less important), "bold", "small", "middle", "end"
  /// (anchors)
  void text(double x, double y, const std::string& content, const std::string& look = "ink");
  /// Writes text upwards, centred on a point.
  void text_upwards(double x, double y, const std::string& content);
  /// @param look class "axis", "grid", "iso" or "front"; "joined" or "bar" with a colour
  void line(const std::vector<ChartPoint>& points, const std::string& look,
            std::optional<Colour> colour = {});
  /// Draws a marker of about 10 pixels. @param hint is shown when a pointer rests on it
  void marker(const ChartPoint& at, const SeriesStyle& look, const std::string& hint);
  /// @param width at least; it grows with the title
  void set_size(double width, double height);
  /// Adds a line below the chart, after its size is set.
  void add_note(const std::string& line);

  [[nodiscard]] bool empty() const { return elements_.empty(); }
  [[nodiscard]] double width() const { return size_.x; }
  /// One <svg> element. Empty if there is no chart.
  /// @param style empty for a page whose style sheet holds `chart_style()`
  [[nodiscard]] std::string svg(const std::string& style = chart_style()) const;

 private:
  std::string name_, title_, description_, elements_;
  ChartPoint size_;
};

/// A time as "1.23 ms", "12.3 ms" or "1.23 s".
std::string ms_text(double ms);

/// A length with at most two decimals: "12.5".
std::string length_text(double value);

/// The approximate width of a text of 12 pixels. The viewer's font is not known, so it cannot be
/// exact.
double text_width(const std::string& text);

}  // namespace raymoval
