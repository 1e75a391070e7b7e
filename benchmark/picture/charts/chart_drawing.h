// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/picture/canvas/colours.h"

struct _cairo;

namespace raymoval {

/// How a series of points looks. Both colour and shape differ from one series to the next, so that
/// readers need not see both.
struct SeriesLook {
  Colour colour;
  int shape = 0;  ///< 0 .. 4: circle, square, diamond, triangle up, triangle down.
};
/// @param count of the series in the chart, each of which has a colour of its own
SeriesLook series_look(std::size_t index, std::size_t count);

/// The charts' style as CSS. The colours of text, lines and ground are the custom properties
/// --chart-ink, --chart-soft, --chart-line and --chart-ground. They follow prefers-color-scheme; a
/// page with a switch between light and dark sets them itself.
std::string chart_style();

/// In pixels, x to the right, y down.
struct ChartPoint {
  double x = 0.0, y = 0.0;
};

enum class ShapeKind { kText, kTextUpwards, kLine, kPolyline, kRectangle, kCircle, kPolygon };

/// A piece of a chart, as it becomes an element of SVG.
struct ChartShape {
  ShapeKind kind;
  std::string look;                ///< Classes, whose meaning the charts' style has.
  std::vector<ChartPoint> points;  ///< Of a rectangle: a corner, then width and height.
  std::string content = {};        ///< A text, or the hint of a mark.
  std::optional<Colour> colour = {};
};

/// A chart: its shapes in the order in which they are drawn. It becomes SVG, or is drawn by cairo
/// in the light colours.
class ChartDrawing {
 public:
  ChartDrawing() = default;  ///< No chart.
  /// @param name distinguishes the chart's ids from those of other charts in a page
  ChartDrawing(const std::string& name, const std::string& title, const std::string& description);

  /// @param look classes: "ink", "soft" (less important), "bold", "middle", "end" (anchors)
  void text(double x, double y, const std::string& content, const std::string& look = "ink") {
    shapes_.push_back({ShapeKind::kText, look, {{x, y}}, content});
  }
  /// Writes text upwards, centred on a point.
  void text_upwards(double x, double y, const std::string& content) {
    shapes_.push_back({ShapeKind::kTextUpwards, "middle", {{x, y}}, content});
  }
  /// @param look classes "axis", "grid", "iso" or "front"
  void line(double x0, double y0, double x1, double y1, const std::string& look) {
    shapes_.push_back({ShapeKind::kLine, look, {{x0, y0}, {x1, y1}}});
  }
  /// @param points at least one
  /// @param look as for `line`, or "joined" with a colour
  void polyline(std::vector<ChartPoint> points, const std::string& look,
                std::optional<Colour> colour = {}) {
    shapes_.push_back({ShapeKind::kPolyline, look, std::move(points), "", colour});
  }
  void rectangle(double x, double y, double width, double height, const Colour& colour,
                 const std::string& hint) {
    shapes_.push_back({ShapeKind::kRectangle, "mark", {{x, y}, {width, height}}, hint, colour});
  }
  /// Draws a marker of about 10 pixels; `hint` is shown when a pointer rests on it.
  void marker(double x, double y, const SeriesLook& look, const std::string& hint);
  void set_size(double width, double height) { size_ = {width, height}; }

  [[nodiscard]] bool empty() const { return shapes_.empty(); }
  [[nodiscard]] double width() const { return size_.x; }
  [[nodiscard]] double height() const { return size_.y; }

  /// One <svg> element with lengths rounded to hundredths. Empty if there is no chart.
  /// @param style empty for a page whose style sheet holds `chart_style()`
  [[nodiscard]] std::string svg(const std::string& style = chart_style()) const;
  /// Draws the chart on its ground. Whether that succeeded is the status of `context`.
  /// @param scale units of `context` for each pixel of the chart
  /// @throws ConfigurationError if there is no font
  void draw(_cairo* context, double scale = 1.0) const;

 private:
  std::string name_, title_, description_;
  std::vector<ChartShape> shapes_;
  ChartPoint size_;
};

/// A length with at most two decimals: "12.5".
std::string length_text(double value);

/// The approximate width of a text of 12 pixels. The viewer's font is not known, so it cannot be
/// exact.
double text_width(const std::string& text);

}  // namespace raymoval
