// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "benchmark/picture/charts/chart_drawing.h"
#include "benchmark/result/results.h"
#include "eval/rate.h"

namespace raymoval {

/// What is drawn alike in a chart: a method, or all points of a sweep.
struct ChartSeries {
  std::string name;
  SeriesLook look;
  std::vector<std::string> cells;  ///< Names in the run, in its order.
};

/// The run's methods without controls.
std::vector<ChartSeries> chart_series(const RunResults& results);

/// The rates of a protocol that charts show.
struct ChartRates {
  std::optional<RateSpec> kept, removed, headline;

  /// What 1 is in the headline rate if it is the harmonic mean of the other two; else nothing, and
  /// no lines of equal headline rate can be drawn.
  [[nodiscard]] std::optional<double> harmonic_unit() const;
};

/// The first rate of each role that results by `protocol` have.
ChartRates chart_rates(const RunResults& results, const std::string& protocol);

/// An axis from `low` to `high`, drawn over `length` pixels, with marks every `step`.
struct LinearAxis {
  double low = 0.0, high = 100.0, step = 20.0;
  bool reversed = false;  ///< Whether it is drawn from `high` to `low`.

  [[nodiscard]] double at(double value, double length) const {
    return (reversed ? high - value : value - low) / (high - low) * length;
  }
  [[nodiscard]] std::vector<double> marks() const;
};

/// An axis that ends at the best value of a rate and begins at a round number beyond `worst`.
LinearAxis axis_to_best(const RateSpec& rate, double worst);
/// An axis that begins at 0 and ends at a round number above `most`.
LinearAxis axis_from_zero(double most);

/// An axis with both values, from a round number to another. @param low less than `high`
LinearAxis axis_between(double low, double high);

/// Draws the grid, the axes and their marks' values of a square plot.
/// @param corner its upper left one
void draw_scales(ChartDrawing& chart, const LinearAxis& across, const LinearAxis& up,
                 const ChartPoint& corner, double side);

/// The name of a rate with its unit: "PR, %".
std::string axis_title(const RateSpec& rate);

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
  void draw(ChartDrawing& chart) const;

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
double draw_legend(ChartDrawing& chart, const std::vector<ChartSeries>& series, double x, double y,
                   double width);

}  // namespace raymoval
