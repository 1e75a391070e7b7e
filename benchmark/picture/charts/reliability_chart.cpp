// SPDX-License-Identifier: MIT
#include <algorithm>

#include "benchmark/picture/charts/charts.h"
#include "benchmark/picture/charts/plot.h"
#include "core/text.h"

namespace raymoval {
namespace {

std::vector<PlotPoint> bin_points(const MethodReliability& method) {
  std::vector<PlotPoint> points;
  for (const ReliabilityBin& bin : method.all.bins) {
    if (bin.points < kFewestInBin) continue;
    const double confidence = *bin.mean_confidence(), share = *bin.moving_share();
    points.push_back({confidence, share,
                      method.cell + ": said " + fixed_text(confidence, 3) + ", " +
                          fixed_text(share, 3) + " of " +
                          counted_text(static_cast<std::uint64_t>(bin.points), "point") + " move"});
  }
  return points;
}

}  // namespace

Chart reliability_chart(const RunResults& results) {
  constexpr ChartPoint kCorner{56.0, 44.0}, kSize{300.0, 300.0};
  constexpr Axis kShares{0.0, 1.0, 0.2};
  if (results.reliability.empty()) return {};
  Chart chart("reliability", "Confidence of points, and the share of them that moves",
              "A line for each method, a marker for each bin of confidence with " +
                  std::to_string(kFewestInBin) +
                  " points or more. The dotted line is perfect calibration.");
  Plot plot(chart, kCorner, kSize, kShares, kShares, "mean confidence", "share that moves");
  chart.line({plot.at(0.0, 0.0), plot.at(1.0, 1.0)}, "iso");
  std::vector<ChartSeries> series;
  for (const ChartSeries& known : chart_series(results)) {  // The colours of the other charts.
    for (const MethodReliability& method : results.reliability) {
      if (std::ranges::find(known.cells, method.cell) == known.cells.end()) continue;
      series.push_back({method.cell, known.look, {method.cell}});
      plot.draw_series(series.back(), bin_points(method), true);
    }
  }
  finish_with_legend(chart, series, kCorner.y + kSize.y + 52.0, kCorner.x + kSize.x + 30.0);
  return chart;
}

}  // namespace raymoval
