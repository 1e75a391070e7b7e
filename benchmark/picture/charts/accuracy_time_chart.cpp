// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmark/picture/charts/charts.h"
#include "benchmark/picture/charts/plot.h"
#include "core/text.h"
#include "eval/averages.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr ChartPoint kTimeCorner{64.0, 48.0}, kTimeSize{640.0, 340.0};
constexpr std::size_t kMostNamed = 12;  ///< Methods that have their names beside their markers.

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
  const double right = kTimeCorner.x + kTimeSize.x;
  chart.line({points.back(), {right, points.back().y}}, "front");
  chart.text(right - 4.0, points.back().y - 8.0, "Pareto line", "soft end");
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
            axis_to_best(*rate, spots.back().accuracy), "ms per scan, log scale (lower is better)",
            "mean " + axis_title(*rate));
  draw_front(chart, plot, spots, *rate);
  for (const Spot& spot : spots) {
    std::string hint = spot.cell + ": mean " + rate->name + " " +
                       rate_text(rate->name, spot.accuracy) + ", " + ms_text(spot.ms) + " per scan";
    if (spot.sequences < results.sequences.size()) {
      hint += fmt::format(" ({}/{})", spot.sequences, results.sequences.size());
    }
    const bool is_named = !results.is_swept(spot.cell) && spots.size() <= kMostNamed;
    const std::string label = is_named ? spot.cell : sweep_label(results, spot.cell);
    plot.draw_series(spot.series, {{spot.ms, spot.accuracy, hint, label}}, false);
  }
  plot.draw_labels();
  finish_with_legend(chart, chart_series(results), kTimeCorner.y + kTimeSize.y + 52.0,
                     kTimeCorner.x + kTimeSize.x + 30.0);
  return chart;
}

}  // namespace raymoval
