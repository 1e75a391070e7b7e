// SPDX-License-Identifier: MIT
#include <algorithm>

#include "benchmark/picture/charts/chart_parts.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr double kPlotSide = 300.0;
constexpr double kPlotLeft = 56.0;
constexpr double kPlotTop = 44.0;

double across(double confidence) {
  return kPlotLeft + confidence * kPlotSide;
}
double upwards(double share) {
  return kPlotTop + (1.0 - share) * kPlotSide;
}

void draw_plot(SvgWriter& svg) {
  for (const double mark : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    svg.line(across(mark), upwards(0.0), across(mark), upwards(1.0), "grid");
    svg.line(across(0.0), upwards(mark), across(1.0), upwards(mark), "grid");
    svg.text(across(mark), upwards(0.0) + 16.0, length_text(mark), "soft middle");
    svg.text(across(0.0) - 6.0, upwards(mark) + 4.0, length_text(mark), "soft end");
  }
  svg.line(across(0.0), upwards(0.0), across(1.0), upwards(1.0), "iso");
  svg.polyline(point_text(across(0.0), upwards(1.0)) + point_text(across(0.0), upwards(0.0)) +
                   point_text(across(1.0), upwards(0.0)),
               "axis");
  svg.text(across(0.5), upwards(0.0) + 34.0, "mean confidence", "middle");
  svg.text_upwards(kPlotLeft - 38.0, upwards(0.5), "share that moves");
}

std::string bin_hint(const std::string& method, const ReliabilityBin& bin) {
  return method + ": said " + fixed_text(*bin.mean_confidence(), 3) + ", " +
         fixed_text(*bin.moving_share(), 3) + " of " +
         counted_text(static_cast<std::uint64_t>(bin.points), "point") + " move";
}

void draw_method(SvgWriter& svg, const MethodReliability& method, const SeriesLook& look) {
  std::string joined;
  for (const ReliabilityBin& bin : method.all.bins) {
    if (bin.points < kFewestInBin) continue;
    joined += point_text(across(*bin.mean_confidence()), upwards(*bin.moving_share()));
  }
  if (!joined.empty()) svg.polyline(joined, "joined", colour_text(look.colour));
  for (const ReliabilityBin& bin : method.all.bins) {
    if (bin.points < kFewestInBin) continue;
    svg.marker(across(*bin.mean_confidence()), upwards(*bin.moving_share()), look,
               bin_hint(method.cell, bin));
  }
}

}  // namespace

std::string reliability_chart(const RunResults& results, ChartPlace place) {
  if (results.reliability.empty()) return "";
  const std::string title = "What methods say of points, and what comes true";
  SvgWriter svg("reliability", title,
                "A line for each method, a marker for each bin of confidence with " +
                    std::to_string(kFewestInBin) +
                    " points or more. On the dotted line, what is said comes true.");
  svg.text(16.0, 22.0, title, "bold");
  draw_plot(svg);
  std::vector<ChartSeries> series;
  for (std::size_t i = 0; i < results.reliability.size(); ++i) {
    const MethodReliability& method = results.reliability[i];
    series.push_back({method.cell, series_look(i, results.reliability.size()), {method.cell}});
    draw_method(svg, method, series.back().look);
  }
  const double width = std::max(across(1.0) + 30.0, legend_width(series) + 32.0);
  const double top = upwards(0.0) + 52.0;
  const double legend = draw_legend(svg, series, 16.0, top, width - 32.0);
  return svg.finish(std::max(width, text_width(title) * 1.1 + 32.0), top + legend + 14.0, place);
}

}  // namespace raymoval
