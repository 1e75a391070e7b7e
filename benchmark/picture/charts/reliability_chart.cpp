// SPDX-License-Identifier: MIT
#include <algorithm>

#include "benchmark/picture/charts/chart_parts.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr double kReliabilitySide = 300.0;
constexpr double kReliabilityLeft = 56.0;
constexpr double kReliabilityTop = 44.0;

double across(double confidence) {
  return kReliabilityLeft + confidence * kReliabilitySide;
}
double upwards(double share) {
  return kReliabilityTop + (1.0 - share) * kReliabilitySide;
}

void draw_plot(ChartDrawing& chart) {
  for (const double mark : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    chart.line(across(mark), upwards(0.0), across(mark), upwards(1.0), "grid");
    chart.line(across(0.0), upwards(mark), across(1.0), upwards(mark), "grid");
    chart.text(across(mark), upwards(0.0) + 16.0, length_text(mark), "soft middle");
    chart.text(across(0.0) - 6.0, upwards(mark) + 4.0, length_text(mark), "soft end");
  }
  chart.line(across(0.0), upwards(0.0), across(1.0), upwards(1.0), "iso");
  chart.polyline(
      {{across(0.0), upwards(1.0)}, {across(0.0), upwards(0.0)}, {across(1.0), upwards(0.0)}},
      "axis");
  chart.text(across(0.5), upwards(0.0) + 34.0, "mean confidence", "middle");
  chart.text_upwards(kReliabilityLeft - 38.0, upwards(0.5), "share that moves");
}

std::string bin_hint(const std::string& method, const ReliabilityBin& bin) {
  return method + ": said " + fixed_text(*bin.mean_confidence(), 3) + ", " +
         fixed_text(*bin.moving_share(), 3) + " of " +
         counted_text(static_cast<std::uint64_t>(bin.points), "point") + " move";
}

void draw_method(ChartDrawing& chart, const MethodReliability& method, const SeriesLook& look) {
  std::vector<ChartPoint> joined;
  std::vector<std::string> hints;
  for (const ReliabilityBin& bin : method.all.bins) {
    if (bin.points < kFewestInBin) continue;
    joined.push_back({across(*bin.mean_confidence()), upwards(*bin.moving_share())});
    hints.push_back(bin_hint(method.cell, bin));
  }
  if (!joined.empty()) chart.polyline(joined, "joined", look.colour);
  for (std::size_t i = 0; i < joined.size(); ++i) {
    chart.marker(joined[i].x, joined[i].y, look, hints[i]);
  }
}

}  // namespace

ChartDrawing reliability_chart(const RunResults& results) {
  if (results.reliability.empty()) return {};
  const std::string title = "What methods say of points, and what comes true";
  ChartDrawing chart("reliability", title,
                     "A line for each method, a marker for each bin of confidence with " +
                         std::to_string(kFewestInBin) +
                         " points or more. On the dotted line, what is said comes true.");
  chart.text(16.0, 22.0, title, "bold");
  draw_plot(chart);
  std::vector<ChartSeries> series;
  for (std::size_t i = 0; i < results.reliability.size(); ++i) {
    const MethodReliability& method = results.reliability[i];
    series.push_back({method.cell, series_look(i, results.reliability.size()), {method.cell}});
    draw_method(chart, method, series.back().look);
  }
  const double width = std::max(across(1.0) + 30.0, legend_width(series) + 32.0);
  const double top = upwards(0.0) + 52.0;
  const double legend = draw_legend(chart, series, 16.0, top, width - 32.0);
  chart.set_size(std::max(width, text_width(title) * 1.1 + 32.0), top + legend + 14.0);
  return chart;
}

}  // namespace raymoval
