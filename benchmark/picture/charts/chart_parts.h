// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/picture/charts/svg.h"
#include "benchmark/result/results.h"

namespace raymoval {

/// What is drawn alike in a chart: a method, or all points of a sweep.
struct ChartSeries {
  std::string name;
  SeriesLook look;
  std::vector<std::string> cells;  ///< Names in the run, in its order.
};

/// The run's methods without controls.
std::vector<ChartSeries> chart_series(const RunResults& results);

/// The two rates that are played against each other and their harmonic mean, with what 1 is in it.
struct RateTrio {
  std::string across;  ///< "RR" or "DA", percent.
  std::string up;      ///< "PR" or "SA", percent.
  std::string mean;    ///< "F1", a fraction, or "HA", percent.
  double mean_unit = 1.0;
};

/// Those of a protocol; nothing if it has neither trio.
std::optional<RateTrio> rate_trio(const RunResults& results, const std::string& protocol);

/// The value of a rate; nothing if it is undefined or the cell has no result.
std::optional<double> rate_value(const ResultRow* row, const std::string& rate);

/// An axis from `low` to `high`, drawn over `length` pixels, with marks every `step`.
struct LinearAxis {
  double low = 0.0, high = 100.0, step = 20.0;

  [[nodiscard]] double at(double value, double length) const {
    return (value - low) / (high - low) * length;
  }
  [[nodiscard]] std::vector<double> marks() const;
};

/// An axis that ends at `high` and begins at a round number below `least`.
LinearAxis axis_up_to(double least, double high);
/// An axis that begins at 0 and ends at a round number above `most`.
LinearAxis axis_from_zero(double most);

/// Texts beside points, where they cover neither points nor each other if there is room.
class PointLabels {
 public:
  /// @param left,right between which texts stand where there is room, in pixels
  /// @param top below which they do
  PointLabels(double left, double right, double top) : left_(left), right_(right), top_(top) {}
  /// Keeps a point free that is drawn at (x, y).
  void add_point(double x, double y);
  /// Says `text` beside the point at (x, y). Points of one series in nearly one place share a text:
  /// "0.1, 0.2".
  void add_text(double x, double y, const std::string& series, const std::string& text);
  void draw(SvgWriter& svg) const;

 private:
  struct Text {
    double x, y;
    std::string series;
    std::vector<std::string> parts;
  };
  double left_, right_, top_;
  std::vector<std::pair<double, double>> points_;
  std::vector<Text> texts_;
};

/// What a point of a sweep was set to: "0.2", or "0.2, true" of two parameters; empty for others.
std::string sweep_label(const RunResults& results, const std::string& cell);

/// How wide a legend has to be for its longest name.
double legend_width(const std::vector<ChartSeries>& series);

/// Draws markers and names in rows; @return the height it takes.
double draw_legend(SvgWriter& svg, const std::vector<ChartSeries>& series, double x, double y,
                   double width);

}  // namespace raymoval
