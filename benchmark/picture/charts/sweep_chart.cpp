// SPDX-License-Identifier: MIT
#include <algorithm>

#include "benchmark/picture/charts/charts.h"
#include "benchmark/picture/charts/plot.h"
#include "core/text.h"
#include "eval/averages.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr double kSweepSide = 230.0;  ///< Of a plot.
constexpr double kSweepPitch = 304.0;
constexpr double kSweepRowPitch = 344.0;
constexpr double kSweepLeft = 56.0;
constexpr double kSweepTop = 92.0;

/// A sweep over one parameter that is a number.
struct NumberSweep {
  std::string name;  ///< SweptCell::sweep().
  std::string parameter;
  std::vector<std::pair<double, std::string>> points;  ///< Value and cell, the least value first.
};

std::vector<NumberSweep> number_sweeps(const RunResults& results) {
  std::vector<NumberSweep> sweeps;
  for (const Sweep& sweep : sweeps_of(results)) {
    if (sweep.points.front()->values.size() != 1) continue;
    NumberSweep numbers{sweep.name, sweep.points.front()->values.front().first, {}};
    for (const SweptCell* point : sweep.points) {
      const auto value = parse_number<double>(point->values.front().second);
      if (value) numbers.points.emplace_back(*value, point->cell);
    }
    std::ranges::sort(numbers.points);
    if (numbers.points.empty()) continue;
    if (numbers.points.front().first != numbers.points.back().first) sweeps.push_back(numbers);
  }
  return sweeps;
}

/// Values of a rate over the parameter, on one sequence or their mean.
struct Curve {
  ChartSeries series;
  std::vector<PlotPoint> points;
};

/// A curve for each sequence, and their mean where all of several have a value.
std::vector<Curve> curves_of(const RunResults& results, const NumberSweep& sweep,
                             const std::string& protocol, const std::string& rate) {
  const std::size_t count = results.sequences.size();
  std::vector<Curve> curves;
  const auto add_point = [&](double value, double at) {
    Curve& curve = curves.back();
    curve.points.push_back({value, at,
                            curve.series.name + " at " + sweep.parameter + " " +
                                length_text(value) + ": " + rate + " " + rate_text(rate, at)});
  };
  for (const std::string& sequence : results.sequences) {
    curves.push_back({{sequence, series_style(curves.size() + 1, count + 1), {}}, {}});
    for (const auto& [value, cell] : sweep.points) {
      const auto there = results.rate(sequence, cell, protocol, rate);
      if (there) add_point(value, *there);
    }
  }
  if (count < 2) return curves;
  curves.push_back({{"mean", series_style(0, count + 1), {}}, {}});
  for (const auto& [value, cell] : sweep.points) {
    const Mean mean = mean_of(results.values(cell, protocol, rate));
    if (mean.value && mean.segments == count) add_point(value, *mean.value);
  }
  return curves;
}

/// Draws one rate over the parameter of a sweep. @return false if it has no value
bool draw_rate(Chart& chart, const NumberSweep& sweep, const RateSpec& rate,
               const std::vector<Curve>& curves, const ChartPoint& corner) {
  double worst = rate.best();
  bool any = false;
  for (const Curve& curve : curves) {
    any = any || !curve.points.empty();
    for (const PlotPoint& point : curve.points) {
      if (rate.is_better(worst, point.y)) worst = point.y;
    }
  }
  if (!any) return false;
  chart.text(corner.x, corner.y - 10.0, axis_title(rate), "bold");
  Plot plot(chart, corner, {kSweepSide, kSweepSide},
            axis_between(sweep.points.front().first, sweep.points.back().first),
            axis_to_best(rate, worst), sweep.parameter, "");
  for (const Curve& curve : curves) plot.draw_series(curve.series, curve.points, true);
  return true;
}

}  // namespace

Chart sweep_chart(const RunResults& results, const std::string& protocol) {
  const ChartRates rates(results, protocol);
  Chart chart("sweeps-" + protocol, "Rates over a parameter by protocol " + protocol,
              "A row of plots for each sweep, a plot for each rate, a line for each sequence and "
              "their mean. Up is better.");
  double top = kSweepTop, width = 0.0;
  std::vector<ChartSeries> legend;
  for (const NumberSweep& sweep : number_sweeps(results)) {
    double left = kSweepLeft;
    for (const auto& rate : {rates.kept, rates.removed, rates.headline}) {
      if (!rate) continue;
      const std::vector<Curve> curves = curves_of(results, sweep, protocol, rate->name);
      if (!draw_rate(chart, sweep, *rate, curves, {left, top})) continue;
      left += kSweepPitch;
      legend.clear();
      for (const Curve& curve : curves) legend.push_back(curve.series);
    }
    if (left == kSweepLeft) continue;
    chart.text(16.0, top - 40.0, sweep.name);
    width =
        std::max({width, left - kSweepPitch + kSweepSide + 32.0, text_width(sweep.name) + 48.0});
    top += kSweepRowPitch;
  }
  if (legend.empty()) return {};
  finish_with_legend(chart, legend, top - 50.0, width);
  return chart;
}

}  // namespace raymoval
