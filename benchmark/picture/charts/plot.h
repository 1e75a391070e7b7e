// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/picture/charts/chart.h"
#include "benchmark/result/results.h"
#include "eval/rate.h"

namespace raymoval {

/// A series with one look in a chart: a method, or all points of a sweep.
struct ChartSeries {
  std::string name;
  SeriesStyle look;
  std::vector<std::string> cells;  ///< Names in the run, in its order.
};

/// The run's methods without controls.
std::vector<ChartSeries> chart_series(const RunResults& results);

/// The first rate of each role that results by a protocol have.
struct ChartRates {
  std::optional<RateSpec> kept, removed, headline;

  ChartRates(const RunResults& results, const std::string& protocol);
};

/// The values of a point of a sweep: "0.2", or "0.2, true" for two parameters; empty for other
/// cells.
std::string sweep_label(const RunResults& results, const std::string& cell);

/// An axis from `low` to `high` with marks every `step`.
struct Axis {
  double low = 0.0, high = 100.0, step = 20.0;
  bool reversed = false;     ///< Whether it is drawn from `high` to `low`.
  bool logarithmic = false;  ///< Whether `low`, `high` and `step` are decimal logarithms.

  /// The position of a value on an axis of `length` pixels.
  [[nodiscard]] double at(double value, double length) const;
  /// The marked values.
  [[nodiscard]] std::vector<double> marks() const;
};

/// An axis that ends at the best value of a rate and begins at a round number beyond `worst`.
Axis axis_to_best(const RateSpec& rate, double worst);
/// An axis with both values, from a round number to another. @param low less than `high`
Axis axis_between(double low, double high);

/// The name of a rate with its unit and the better direction: "PR, % (higher is better)".
std::string axis_title(const RateSpec& rate);

/// A point of a plot, in units of its axes.
struct PlotPoint {
  double x = 0.0, y = 0.0;
  std::string hint;        ///< Shown when a pointer rests on the marker.
  std::string label = {};  ///< Text beside the marker.
};

/// A rectangle with two axes, in which series of points are drawn.
class Plot {
 public:
  /// Draws the grid, the axes, their marks' values and their titles.
  /// @param corner the upper left one, in pixels
  /// @param size width and height, in pixels
  Plot(Chart& chart, const ChartPoint& corner, const ChartPoint& size, const Axis& across,
       const Axis& up, const std::string& across_title, const std::string& up_title);

  /// The position of a point in the chart.
  [[nodiscard]] ChartPoint at(double x, double y) const;
  void draw_series(const ChartSeries& series, const std::vector<PlotPoint>& points, bool joined);
  /// Writes the labels of all points. If there is room, they cover neither points nor each other.
  /// Points of one series in nearly one place share a label: "0.1, 0.2".
  void draw_labels() const;

 private:
  struct Label {
    ChartPoint at;
    std::string series;
    std::vector<std::string> parts;
  };
  void add_label(const ChartPoint& at, const std::string& series, const std::string& text);

  Chart& chart_;
  ChartPoint corner_, size_;
  Axis across_, up_;
  std::vector<ChartPoint> points_;
  std::vector<Label> labels_;
};

/// Draws markers and names in rows from `top` down, and sets the chart's size.
/// @param width of the chart at least
void finish_with_legend(Chart& chart, const std::vector<ChartSeries>& series, double top,
                        double width);

}  // namespace raymoval
