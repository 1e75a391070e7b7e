// SPDX-License-Identifier: MIT
#include <algorithm>

#include "benchmark/picture/charts/chart_parts.h"
#include "core/text.h"
#include "eval/averages.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr double kPlotSide = 230.0;
constexpr double kPlotPitch = 304.0;
constexpr double kPlotRowPitch = 344.0;
constexpr double kFirstLeft = 56.0;
constexpr double kFirstTop = 92.0;

/// A sweep over one parameter that is a number.
struct NumberSweep {
  std::string name;  ///< SweptCell::sweep().
  std::string parameter;
  std::vector<std::pair<double, std::string>> points;  ///< Value and cell, the least value first.
};

std::vector<NumberSweep> number_sweeps(const RunResults& results) {
  std::vector<NumberSweep> sweeps;
  for (const SweptCell& point : results.sweeps) {
    if (point.values.size() != 1) continue;
    const auto& [parameter, text] = point.values.front();
    const std::optional<double> value = parse_number<double>(text);
    if (!value) continue;
    const std::string name = point.sweep();
    auto sweep = std::find_if(sweeps.begin(), sweeps.end(),
                              [&](const NumberSweep& known) { return known.name == name; });
    if (sweep == sweeps.end()) sweep = sweeps.insert(sweep, {name, parameter, {}});
    sweep->points.emplace_back(*value, point.cell);
  }
  std::erase_if(sweeps, [](NumberSweep& sweep) {
    std::sort(sweep.points.begin(), sweep.points.end());
    return sweep.points.front().first == sweep.points.back().first;
  });
  return sweeps;
}

/// The rates that a row of plots shows: what is kept, what is removed, and the headline.
std::vector<RateSpec> plotted_rates(const RunResults& results, const std::string& protocol) {
  const ChartRates rates = chart_rates(results, protocol);
  std::vector<RateSpec> plotted;
  for (const auto& rate : {rates.kept, rates.removed, rates.headline}) {
    if (rate) plotted.push_back(*rate);
  }
  return plotted;
}

/// Values of a rate over the parameter, on one sequence or their mean.
struct Curve {
  std::string name;
  SeriesLook look;
  std::vector<std::pair<double, double>> points;
};

/// A curve for each sequence, and their mean where all of several have a value.
std::vector<Curve> curves_of(const RunResults& results, const NumberSweep& sweep,
                             const std::string& protocol, const std::string& rate) {
  const std::size_t count = results.sequences.size();
  std::vector<Curve> curves;
  for (const std::string& sequence : results.sequences) {
    curves.push_back({sequence, series_look(curves.size() + 1, count + 1), {}});
    for (const auto& [value, cell] : sweep.points) {
      const ResultRow* row = results.find(sequence, cell, protocol);
      const auto there = row == nullptr ? std::nullopt : row->rate(rate);
      if (there) curves.back().points.emplace_back(value, *there);
    }
  }
  if (count < 2) return curves;
  curves.push_back({"mean", series_look(0, count + 1), {}});
  for (const auto& [value, cell] : sweep.points) {
    const Mean mean = mean_of(results.values(cell, protocol, rate));
    if (mean.value && mean.segments == count) curves.back().points.emplace_back(value, *mean.value);
  }
  return curves;
}

bool has_points(const std::vector<Curve>& curves) {
  return std::any_of(curves.begin(), curves.end(),
                     [](const Curve& curve) { return !curve.points.empty(); });
}

/// One rate over the parameter of a sweep; `left`, `top` is the plot's upper left corner.
class RatePlot {
 public:
  RatePlot(ChartDrawing& chart, const NumberSweep& sweep, const RateSpec& rate, double left,
           double top)
      : chart_(chart), parameter_(sweep.parameter), rate_(rate), left_(left), top_(top) {
    across_ = axis_between(sweep.points.front().first, sweep.points.back().first);
  }

  void draw(const std::vector<Curve>& curves) {
    double worst = rate_.best();
    for (const Curve& curve : curves) {
      for (const auto& [value, rate] : curve.points) {
        if (rate_.is_better(worst, rate)) worst = rate;
      }
    }
    up_ = axis_to_best(rate_, worst);
    draw_axes();
    for (const Curve& curve : curves) draw_curve(curve);
  }

 private:
  void draw_axes() {
    draw_scales(chart_, across_, up_, {left_, top_}, kPlotSide);
    chart_.text(left_ + kPlotSide / 2.0, top_ + kPlotSide + 32.0, parameter_, "middle");
    chart_.text(left_, top_ - 10.0, axis_title(rate_), "bold");
  }

  void draw_curve(const Curve& curve) {
    std::vector<ChartPoint> joined;
    for (const auto& [value, rate] : curve.points) joined.push_back({to_x(value), to_y(rate)});
    if (curve.points.size() > 1) chart_.polyline(joined, "joined", curve.look.colour);
    for (const auto& [value, rate] : curve.points) {
      chart_.marker(to_x(value), to_y(rate), curve.look,
                    curve.name + " at " + parameter_ + " " + length_text(value) + ": " +
                        rate_.name + " " + rate_text(rate_.name, rate));
    }
  }

  [[nodiscard]] double to_x(double value) const { return left_ + across_.at(value, kPlotSide); }
  [[nodiscard]] double to_y(double value) const {
    return top_ + kPlotSide - up_.at(value, kPlotSide);
  }

  ChartDrawing& chart_;
  std::string parameter_;
  RateSpec rate_;
  double left_, top_;
  LinearAxis across_, up_;
};

}  // namespace

ChartDrawing sweep_chart(const RunResults& results, const std::string& protocol) {
  const std::vector<RateSpec> rates = plotted_rates(results, protocol);
  const std::string title = "Rates over a parameter by protocol " + protocol;
  ChartDrawing chart("sweeps-" + protocol, title,
                     "A row of plots for each sweep, a plot for each rate, a line for each "
                     "sequence and their mean. Up is better.");
  chart.text(16.0, 22.0, title, "bold");
  double top = kFirstTop;
  double width = text_width(title) * 1.1;
  std::vector<ChartSeries> legend;
  for (const NumberSweep& sweep : number_sweeps(results)) {
    double left = kFirstLeft;
    for (const RateSpec& rate : rates) {
      const std::vector<Curve> curves = curves_of(results, sweep, protocol, rate.name);
      if (!has_points(curves)) continue;
      RatePlot(chart, sweep, rate, left, top).draw(curves);
      left += kPlotPitch;
      legend.clear();
      for (const Curve& curve : curves) legend.push_back({curve.name, curve.look, {}});
    }
    if (left == kFirstLeft) continue;
    chart.text(16.0, top - 40.0, sweep.name);
    width = std::max({width, left - kPlotPitch + kPlotSide, text_width(sweep.name) + 16.0});
    top += kPlotRowPitch;
  }
  if (legend.empty()) return {};
  width = std::max(width, legend_width(legend)) + 32.0;
  const double legend_top = top - 50.0;
  const double height = draw_legend(chart, legend, 16.0, legend_top, width - 32.0);
  chart.set_size(width, legend_top + height + 14.0);
  return chart;
}

}  // namespace raymoval
