// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "benchmark/picture/charts/chart_parts.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr double kSide = 230.0;  ///< Of a panel's plot.
constexpr double kPitch = 304.0;
constexpr double kRowPitch = 322.0;
constexpr double kPanelLeft = 56.0;
constexpr double kPanelTop = 70.0;

/// Where the points of all sequences lie.
struct Frame {
  RateSpec across_rate, up_rate;
  std::optional<RateSpec> headline;
  std::optional<double> harmonic_unit;  ///< See `ChartRates`.
  LinearAxis across, up;
};

std::string point_hint(const ResultRow& row, const Frame& frame) {
  std::vector<RateSpec> rates = {frame.up_rate, frame.across_rate};
  if (frame.headline) rates.push_back(*frame.headline);
  std::string text = row.cell + " on " + row.sequence;
  const char* separator = ": ";
  for (const RateSpec& rate : rates) {
    const auto value = row.rate(rate.name);
    if (!value) continue;
    text += separator + rate.name + " " + rate_text(rate.name, *value);
    separator = ", ";
  }
  return text;
}

/// One panel of the chart; `x`, `y` is the plot's upper left corner.
class Panel {
 public:
  Panel(ChartDrawing& chart, const Frame& frame, double x, double y)
      : chart_(chart), frame_(frame), x_(x), y_(y), labels_(x - 30.0, x + kSide + 30.0, y - 6.0) {}

  void draw_axes(const std::string& sequence) {
    chart_.text(x_, y_ - 24.0, sequence, "bold");
    draw_scales(chart_, frame_.across, frame_.up, {x_, y_}, kSide);
    chart_.text(x_ + kSide / 2.0, y_ + kSide + 32.0, axis_title(frame_.across_rate), "middle");
    chart_.text_upwards(x_ - 36.0, y_ + kSide / 2.0, axis_title(frame_.up_rate));
  }

  /// Draws where the harmonic mean of both rates is `level` percent: up = level across / (2 across
  /// - level).
  void draw_iso_line(double level) {
    const double at_hundred = level * 100.0 / (200.0 - level);  // One rate where the other is 100.
    const double low = frame_.up.low;
    const double begin = std::max(frame_.across.low, at_hundred);
    const double end =
        2.0 * low > level ? std::min(100.0, level * low / (2.0 * low - level)) : 100.0;
    if (begin >= end) return;
    constexpr int kPieces = 32;
    std::vector<ChartPoint> points;
    for (int i = 0; i <= kPieces; ++i) {
      const double across = begin + (end - begin) * i / kPieces;
      points.push_back({to_x(across), to_y(level * across / (2.0 * across - level))});
    }
    chart_.polyline(points, "iso");
    label_iso_line(level, at_hundred);
  }

  /// @return whether there was anything to draw
  bool draw_series(const ChartSeries& series, const RunResults& results,
                   const std::string& sequence, const std::string& protocol) {
    std::vector<ChartPoint> joined;
    std::vector<const ResultRow*> rows;
    for (const std::string& cell : series.cells) {
      const ResultRow* row = results.find(sequence, cell, protocol);
      if (row == nullptr) continue;
      const auto across = row->rate(frame_.across_rate.name), up = row->rate(frame_.up_rate.name);
      if (!across || !up) continue;
      rows.push_back(row);
      joined.push_back({to_x(*across), to_y(*up)});
    }
    if (rows.size() > 1) chart_.polyline(joined, "joined", series.look.colour);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto [x, y] = joined[i];
      chart_.marker(x, y, series.look, point_hint(*rows[i], frame_));
      labels_.add_point(x, y);
      labels_.add_text(x, y, series.name, sweep_label(results, rows[i]->cell));
    }
    return !rows.empty();
  }

  /// What the points of sweeps were set to, when all are drawn.
  void draw_labels() { labels_.draw(chart_); }

  void say_empty() { chart_.text(x_ + kSide / 2.0, y_ + kSide / 2.0, "no result", "soft middle"); }

 private:
  /// At the upper edge, or at the right one if the line does not get there; not over another label.
  void label_iso_line(double level, double at_hundred) {
    const std::string text = length_text(level / 100.0 * *frame_.harmonic_unit);
    if (at_hundred < frame_.across.low) {
      if (at_hundred < frame_.up.low) return;  // It leaves the plot at the lower edge.
      chart_.text(x_ + kSide + 4.0, to_y(at_hundred) + 4.0, text, "soft");
    } else if (to_x(at_hundred) > last_label_ + 26.0) {
      last_label_ = to_x(at_hundred);
      chart_.text(last_label_, y_ - 6.0, text, "soft middle");
    }
  }
  [[nodiscard]] double to_x(double value) const { return x_ + frame_.across.at(value, kSide); }
  [[nodiscard]] double to_y(double value) const { return y_ + kSide - frame_.up.at(value, kSide); }

  ChartDrawing& chart_;
  const Frame& frame_;
  double x_, y_;
  double last_label_ = -1e9;
  PointLabels labels_;
};

/// Axes that show every point; nothing if there is none.
std::optional<Frame> frame_of(const RunResults& results, const std::string& protocol) {
  const ChartRates rates = chart_rates(results, protocol);
  if (!rates.kept || !rates.removed) return std::nullopt;
  double worst_across = rates.removed->best(), worst_up = rates.kept->best();
  bool any = false;
  for (const ResultRow& row : results.rows) {
    const auto across = row.rate(rates.removed->name), up = row.rate(rates.kept->name);
    if (row.protocol != protocol || row.control || !across || !up) continue;
    if (rates.removed->is_better(worst_across, *across)) worst_across = *across;
    if (rates.kept->is_better(worst_up, *up)) worst_up = *up;
    any = true;
  }
  if (!any) return std::nullopt;
  return Frame{*rates.removed,
               *rates.kept,
               rates.headline,
               rates.harmonic_unit(),
               axis_to_best(*rates.removed, worst_across),
               axis_to_best(*rates.kept, worst_up)};
}

/// Levels of the lines of equal harmonic mean, percent.
std::vector<double> iso_levels(const Frame& frame) {
  if (!frame.harmonic_unit) return {};
  const double span = std::max(100.0 - frame.up.low, 100.0 - frame.across.low);
  const double step = span > 40.0 ? 10.0 : (span > 15.0 ? 5.0 : (span > 5.0 ? 2.0 : 0.5));
  std::vector<double> levels;
  for (double level = step; level < 100.0; level += step) levels.push_back(level);
  return levels;
}

}  // namespace

ChartDrawing pr_rr_chart(const RunResults& results, const std::string& protocol) {
  const auto frame = frame_of(results, protocol);
  if (!frame) return {};
  const std::vector<ChartSeries> series = chart_series(results);
  const std::string title =
      frame->up_rate.name + " against " + frame->across_rate.name + " by protocol " + protocol;
  const std::string dotted = frame->harmonic_unit ? frame->headline->name : "";
  ChartDrawing chart("rates-" + protocol, title,
                     "A panel for each sequence, a marker for each method" +
                         (dotted.empty() ? "" : ", dotted lines of equal " + dotted) +
                         ". Up and right is better.");
  const std::size_t columns =
      std::min<std::size_t>(3, std::max<std::size_t>(1, results.sequences.size()));
  chart.text(16.0, 22.0, title + (dotted.empty() ? "" : "; dotted: equal " + dotted), "bold");
  for (std::size_t i = 0; i < results.sequences.size(); ++i) {
    Panel panel(chart, *frame, kPanelLeft + static_cast<double>(i % columns) * kPitch,
                kPanelTop + static_cast<double>(i / columns) * kRowPitch);
    panel.draw_axes(results.sequences[i]);
    for (const double level : iso_levels(*frame)) panel.draw_iso_line(level);
    bool any = false;
    for (const ChartSeries& item : series) {
      any = panel.draw_series(item, results, results.sequences[i], protocol) || any;
    }
    panel.draw_labels();
    if (!any) panel.say_empty();
  }
  const double width =
      std::max(16.0 + std::max(static_cast<double>(columns), 2.0) * kPitch,
               std::max(legend_width(series), text_width(title) * 1.1 + 130.0) + 32.0);
  const std::size_t rows = (results.sequences.size() + columns - 1) / columns;
  const double legend_top = kPanelTop - 14.0 + static_cast<double>(rows) * kRowPitch;
  const double legend = draw_legend(chart, series, 16.0, legend_top, width - 32.0);
  chart.set_size(width, legend_top + legend + 14.0);
  return chart;
}

}  // namespace raymoval
