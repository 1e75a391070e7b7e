// SPDX-License-Identifier: MIT
#include <algorithm>

#include "benchmark/picture/charts/charts.h"
#include "benchmark/picture/charts/plot.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr double kPanelAcross = 74.0;  ///< Between the plots of neighbouring panels.
constexpr double kPanelDown = 92.0;
constexpr double kPanelLeft = 56.0;
constexpr double kPanelTop = 70.0;

/// The common parts of all panels.
struct Panels {
  ChartRates rates;
  Axis across, up;
  bool any = false;  ///< Whether there is a point.
  bool alone;        ///< Whether there is one panel, which is large and has the methods' names.
  double side;       ///< Of a panel's plot.

  /// Axes that show every point.
  Panels(const RunResults& results, const std::string& protocol)
      : rates(results, protocol),
        alone(results.sequences.size() == 1),
        side(alone                          ? 460.0
             : results.sequences.size() > 9 ? 170.0
                                            : 230.0) {
    if (!rates.kept || !rates.removed) return;
    double worst_across = rates.removed->best(), worst_up = rates.kept->best();
    for (const Cell& cell : results.cells) {
      const Score* score = cell.method.control ? nullptr : cell.score(protocol);
      if (score == nullptr) continue;
      const auto removed = score->rate(rates.removed->name), kept = score->rate(rates.kept->name);
      if (!removed || !kept) continue;
      if (rates.removed->is_better(worst_across, *removed)) worst_across = *removed;
      if (rates.kept->is_better(worst_up, *kept)) worst_up = *kept;
      any = true;
    }
    across = axis_to_best(*rates.removed, worst_across);
    up = axis_to_best(*rates.kept, worst_up);
  }

  /// True if the headline rate is the harmonic mean of the other two, both in percent.
  [[nodiscard]] bool harmonic() const {
    if (!rates.headline || !rates.headline->formula) return false;
    const RateFormula& formula = *rates.headline->formula;
    const bool percents =
        rates.kept->unit == RateUnit::kPercent && rates.removed->unit == RateUnit::kPercent;
    return percents && formula.rule == "harmonic_mean" && formula.first == rates.kept->name &&
           formula.second == rates.removed->name;
  }

  /// Levels of the lines of equal harmonic mean, percent.
  [[nodiscard]] std::vector<double> iso_levels() const {
    if (!harmonic()) return {};
    const double span = std::max(100.0 - up.low, 100.0 - across.low);
    const double step = span > 40.0 ? 10.0 : (span > 15.0 ? 5.0 : (span > 5.0 ? 2.0 : 0.5));
    std::vector<double> levels;
    for (double level = step; level < 100.0; level += step) levels.push_back(level);
    return levels;
  }
};

std::string point_hint(const Cell& cell, const Score& score, const ChartRates& rates) {
  std::string text = cell.name + " on " + cell.sequence;
  const char* separator = ": ";
  for (const auto& rate : {rates.kept, rates.removed, rates.headline}) {
    const auto value = rate ? score.rate(rate->name) : std::nullopt;
    if (!value) continue;
    text += separator + rate->name + " " + rate_text(rate->name, *value);
    separator = ", ";
  }
  return text;
}

/// Draws the lines on which the harmonic mean of both rates is a level in percent: up = level
/// across / (2 across - level).
void draw_iso_lines(Chart& chart, const Plot& plot, const Panels& panels) {
  const double right = plot.at(100.0, 100.0).x, top = plot.at(100.0, 100.0).y;
  double last_label = -1e9;  // Labels do not cover each other.
  for (const double level : panels.iso_levels()) {
    const double at_hundred = level * 100.0 / (200.0 - level);  // One rate where the other is 100.
    const double low = panels.up.low;
    const double begin = std::max(panels.across.low, at_hundred);
    const double end =
        2.0 * low > level ? std::min(100.0, level * low / (2.0 * low - level)) : 100.0;
    if (begin >= end) continue;
    constexpr int kPieces = 32;
    std::vector<ChartPoint> points;
    for (int i = 0; i <= kPieces; ++i) {
      const double across = begin + (end - begin) * i / kPieces;
      points.push_back(plot.at(across, level * across / (2.0 * across - level)));
    }
    chart.line(points, "iso");
    // At the upper edge, or at the right one if the line does not reach the upper edge.
    const std::string text = length_text(level / 100.0 * panels.rates.headline->largest());
    if (at_hundred < panels.across.low) {
      if (at_hundred < low) continue;  // The line leaves the plot at the lower edge.
      chart.text(right + 4.0, plot.at(100.0, at_hundred).y + 4.0, text, "soft");
    } else if (plot.at(at_hundred, 100.0).x > last_label + 26.0) {
      last_label = plot.at(at_hundred, 100.0).x;
      chart.text(last_label, top - 6.0, text, "soft middle");
    }
  }
}

void draw_panel(Chart& chart, const RunResults& results, const std::string& protocol,
                const std::string& sequence, const Panels& panels, const ChartPoint& corner) {
  chart.text(corner.x, corner.y - 24.0, sequence, "bold");
  const RateSpec& across = *panels.rates.removed;
  const RateSpec& up = *panels.rates.kept;
  Plot plot(chart, corner, {panels.side, panels.side}, panels.across, panels.up, axis_title(across),
            axis_title(up));
  draw_iso_lines(chart, plot, panels);
  bool any = false;
  for (const ChartSeries& series : chart_series(results)) {
    std::vector<PlotPoint> points;
    for (const std::string& method : series.cells) {
      const auto x = results.rate(sequence, method, protocol, across.name);
      const auto y = results.rate(sequence, method, protocol, up.name);
      if (!x || !y) continue;
      const Cell& cell = *results.find(sequence, method);
      points.push_back(
          {*x, *y, point_hint(cell, *cell.score(protocol), panels.rates),
           panels.alone && !results.is_swept(method) ? method : sweep_label(results, method)});
    }
    plot.draw_series(series, points, true);
    any = any || !points.empty();
  }
  plot.draw_labels();
  if (any) return;
  chart.text(corner.x + panels.side / 2.0, corner.y + panels.side / 2.0, "no result",
             "soft middle");
}

}  // namespace

Chart pr_rr_chart(const RunResults& results, const std::string& protocol) {
  const Panels panels(results, protocol);
  if (!panels.any) return {};
  const std::string equal = panels.harmonic() ? "equal " + panels.rates.headline->name : "";
  Chart chart("rates-" + protocol,
              panels.rates.kept->name + " against " + panels.rates.removed->name + " by protocol " +
                  protocol + (equal.empty() ? "" : "; dotted: " + equal),
              "A panel for each sequence, a marker for each method" +
                  (equal.empty() ? "" : ", dotted lines of " + equal) +
                  ". Up and right is better.");
  const std::size_t most = results.sequences.size() > 9 ? 5 : 3;
  const std::size_t columns = std::clamp<std::size_t>(results.sequences.size(), 1, most);
  const double across = panels.side + kPanelAcross, down = panels.side + kPanelDown;
  for (std::size_t i = 0; i < results.sequences.size(); ++i) {
    draw_panel(chart, results, protocol, results.sequences[i], panels,
               {kPanelLeft + static_cast<double>(i % columns) * across,
                kPanelTop + static_cast<double>(i / columns) * down});
  }
  const std::size_t rows = (results.sequences.size() + columns - 1) / columns;
  finish_with_legend(chart, chart_series(results),
                     kPanelTop - 14.0 + static_cast<double>(rows) * down,
                     16.0 + std::max(static_cast<double>(columns) * across, 608.0));
  return chart;
}

}  // namespace raymoval
