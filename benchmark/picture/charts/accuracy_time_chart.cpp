// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "benchmark/picture/charts/charts.h"
#include "benchmark/picture/charts/plot.h"
#include "core/text.h"
#include "eval/averages.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr ChartPoint kTimeCorner{64.0, 48.0}, kTimeSize{460.0, 330.0};
constexpr std::size_t kMost = 30;  ///< Names in the list beside the plot before it gets longer.

/// A method in the plane of time and accuracy.
struct Spot {
  std::string cell;
  ChartSeries series;
  double ms = 0.0;
  double accuracy = 0.0;
  std::size_t sequences = 0;  ///< That have a value.
};

/// The most accurate one first.
std::vector<Spot> spots_of(const RunResults& results, const std::string& protocol,
                           const RateSpec& rate) {
  std::vector<Spot> spots;
  for (const ChartSeries& series : chart_series(results)) {
    for (const std::string& cell : series.cells) {
      const Mean mean = mean_of(results.values(cell, protocol, rate.name));
      const auto ms = results.ms_per_scan(cell);
      if (mean.value && ms && *ms > 0.0)
        spots.push_back({cell, series, *ms, *mean.value, mean.segments});
    }
  }
  std::stable_sort(spots.begin(), spots.end(), [&](const Spot& a, const Spot& b) {
    return rate.is_better(a.accuracy, b.accuracy);
  });
  return spots;
}

std::string time_text(double ms) {
  if (ms >= 1000.0) return fixed_text(ms / 1000.0, 2) + " s";
  return fixed_text(ms, ms < 10.0 ? 2 : 1) + " ms";
}

/// Whole powers of ten around the times of all methods.
Axis time_axis(const std::vector<Spot>& spots) {
  const auto [fastest, slowest] = std::minmax_element(
      spots.begin(), spots.end(), [](const Spot& a, const Spot& b) { return a.ms < b.ms; });
  const double low = std::floor(std::log10(fastest->ms) - 0.02);
  return {low, std::max(low + 1.0, std::ceil(std::log10(slowest->ms) + 0.02)), 1.0, false, true};
}

/// Joins the methods than which none is both faster and more accurate.
void draw_front(Chart& chart, const Plot& plot, std::vector<Spot> spots, const RateSpec& rate) {
  std::stable_sort(spots.begin(), spots.end(),
                   [](const Spot& a, const Spot& b) { return a.ms < b.ms; });
  std::vector<ChartPoint> points;
  std::optional<double> best;
  for (const Spot& spot : spots) {
    if (best && !rate.is_better(spot.accuracy, *best)) continue;
    if (best) points.push_back(plot.at(spot.ms, *best));
    best = spot.accuracy;
    points.push_back(plot.at(spot.ms, *best));
  }
  chart.line(points, "front");
}

/// Draws the methods beside the plot, best first. @return width and height of the chart
ChartPoint draw_list(Chart& chart, const std::vector<Spot>& spots, const std::string& rate,
                     std::size_t sequences) {
  const double x = kTimeCorner.x + kTimeSize.x + 34.0;
  double name_width = 60.0;
  for (const Spot& spot : spots) name_width = std::max(name_width, text_width(spot.cell));
  const double row = spots.size() > kMost ? 15.0 : 19.0;
  double y = kTimeCorner.y + 8.0;
  for (const Spot& spot : spots) {
    chart.marker({x, y - 4.0}, spot.series.look, spot.cell);
    chart.text(x + 13.0, y, spot.cell);
    chart.text(x + name_width + 66.0, y, rate_text(rate, spot.accuracy), "ink end");
    chart.text(x + name_width + 138.0, y, time_text(spot.ms), "soft end");
    if (spot.sequences < sequences) {
      chart.text(x + name_width + 146.0, y,
                 "(" + std::to_string(spot.sequences) + "/" + std::to_string(sequences) + ")",
                 "soft");
    }
    y += row;
  }
  return {x + name_width + 196.0, std::max(kTimeCorner.y + kTimeSize.y + 48.0, y + 10.0)};
}

}  // namespace

Chart accuracy_time_chart(const RunResults& results, const std::string& protocol) {
  const std::optional<RateSpec> rate = ChartRates(results, protocol).headline;
  if (!rate) return {};
  const std::vector<Spot> spots = spots_of(results, protocol, *rate);
  if (spots.empty()) return {};
  Chart chart("accuracy-time-" + protocol, "Accuracy against time by protocol " + protocol,
              "A marker for each method: mean " + rate->name +
                  " over the sequences upwards, milliseconds per scan to the right. The line joins "
                  "the methods that no other one beats in both.");
  Plot plot(chart, kTimeCorner, kTimeSize, time_axis(spots),
            axis_to_best(*rate, spots.back().accuracy), "ms per scan (log scale)",
            "mean " + rate->name);
  draw_front(chart, plot, spots, *rate);
  for (const Spot& spot : spots) {
    const std::string hint = spot.cell + ": mean " + rate->name + " " +
                             rate_text(rate->name, spot.accuracy) + ", " + time_text(spot.ms) +
                             " per scan";
    plot.draw_series(spot.series, {{spot.ms, spot.accuracy, hint, sweep_label(results, spot.cell)}},
                     false);
  }
  plot.draw_labels();
  const ChartPoint size = draw_list(chart, spots, rate->name, results.sequences.size());
  chart.set_size(size.x, size.y);
  return chart;
}

}  // namespace raymoval
