// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "benchmark/picture/canvas/colours.h"
#include "benchmark/picture/charts/charts.h"

namespace raymoval {

/// How a series of points looks. Both colour and shape differ from one series to the next, so that
/// readers need not see both.
struct SeriesLook {
  Colour colour;
  int shape = 0;  ///< 0 .. 4: circle, square, diamond, triangle up, triangle down.
};
/// @param count of the series in the chart, each of which has a colour of its own
SeriesLook series_look(std::size_t index, std::size_t count);

/// Writes an <svg> element piece by piece. Lengths in pixels, x to the right, y down, rounded to
/// hundredths.
class SvgWriter {
 public:
  /// @param name distinguishes the chart's ids from those of other charts in a page
  SvgWriter(const std::string& name, const std::string& title, const std::string& description);

  /// @param look classes: "ink", "soft" (less important), "bold", "middle", "end" (anchors)
  void text(double x, double y, const std::string& content, const std::string& look = "ink");
  /// Writes text upwards, centred on a point.
  void text_upwards(double x, double y, const std::string& content);
  /// @param look classes "axis", "grid", "iso" or "front"
  void line(double x0, double y0, double x1, double y1, const std::string& look);
  /// @param points "x,y x,y", see `point_text`
  void polyline(const std::string& points, const std::string& look, const std::string& stroke = "");
  void rectangle(double x, double y, double width, double height, const Colour& colour,
                 const std::string& hint);
  /// Draws a marker of about 10 pixels; `hint` is shown when a pointer rests on it.
  void marker(double x, double y, const SeriesLook& look, const std::string& hint);

  /// The whole element. @param width,height of the chart
  [[nodiscard]] std::string finish(double width, double height, ChartPlace place) const;

 private:
  std::string name_, title_, description_, body_;
};

/// A length with at most two decimals: "12.5".
std::string length_text(double value);
/// "12.5,7 ".
std::string point_text(double x, double y);

/// The approximate width of a text of 12 pixels. The viewer's font is not known, so it cannot be
/// exact.
double text_width(const std::string& text);

}  // namespace raymoval
