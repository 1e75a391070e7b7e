// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "benchmark/picture/charts/chart_parts.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr double kSide = 230.0;  ///< Of a panel's plot.
constexpr double kPitch = 304.0;
constexpr double kRowPitch = 322.0;
constexpr double kLeft = 56.0;
constexpr double kTop = 70.0;

/// Where the points of all sequences lie.
struct Frame {
  RateTrio trio;
  LinearAxis across, up;
};

std::string point_hint(const ResultRow& row, const RateTrio& trio) {
  std::string text = row.cell + " on " + row.sequence;
  const char* separator = ": ";
  for (const std::string& rate : {trio.up, trio.across, trio.mean}) {
    const auto value = rate_value(&row, rate);
    if (!value) continue;
    text += separator + rate + " " + rate_text(rate, *value);
    separator = ", ";
  }
  return text;
}

/// One panel of the chart; `x`, `y` is the plot's upper left corner.
class Panel {
 public:
  Panel(SvgWriter& svg, const Frame& frame, double x, double y)
      : svg_(svg), frame_(frame), x_(x), y_(y), labels_(x - 30.0, x + kSide + 30.0, y - 6.0) {}

  void draw_axes(const std::string& sequence) {
    svg_.text(x_, y_ - 24.0, sequence, "bold");
    for (const double mark : frame_.across.marks()) {
      const double x = to_x(mark);
      svg_.line(x, y_, x, y_ + kSide, "grid");
      svg_.text(x, y_ + kSide + 16.0, length_text(mark), "soft middle");
    }
    for (const double mark : frame_.up.marks()) {
      const double y = to_y(mark);
      svg_.line(x_, y, x_ + kSide, y, "grid");
      svg_.text(x_ - 6.0, y + 4.0, length_text(mark), "soft end");
    }
    svg_.polyline(
        point_text(x_, y_) + point_text(x_, y_ + kSide) + point_text(x_ + kSide, y_ + kSide),
        "axis");
    svg_.text(x_ + kSide / 2.0, y_ + kSide + 32.0, frame_.trio.across + ", %", "middle");
    svg_.text_upwards(x_ - 36.0, y_ + kSide / 2.0, frame_.trio.up + ", %");
  }

  /// Where the harmonic mean of both rates is `level` percent: up = level across / (2 across -
  /// level).
  void draw_iso_line(double level) {
    const double at_hundred = level * 100.0 / (200.0 - level);  // One rate where the other is 100.
    const double low = frame_.up.low;
    const double begin = std::max(frame_.across.low, at_hundred);
    const double end =
        2.0 * low > level ? std::min(100.0, level * low / (2.0 * low - level)) : 100.0;
    if (begin >= end) return;
    constexpr int kPieces = 32;
    std::string points;
    for (int i = 0; i <= kPieces; ++i) {
      const double across = begin + (end - begin) * i / kPieces;
      points += point_text(to_x(across), to_y(level * across / (2.0 * across - level)));
    }
    svg_.polyline(points, "iso");
    label_iso_line(level, at_hundred);
  }

  /// @return whether there was anything to draw
  bool draw_series(const ChartSeries& series, const RunResults& results,
                   const std::string& sequence, const std::string& protocol) {
    std::string joined;
    std::vector<const ResultRow*> rows;
    for (const std::string& cell : series.cells) {
      const ResultRow* row = results.find(sequence, cell, protocol);
      const auto across = rate_value(row, frame_.trio.across);
      const auto up = rate_value(row, frame_.trio.up);
      if (!across || !up) continue;
      rows.push_back(row);
      joined += point_text(to_x(*across), to_y(*up));
    }
    if (rows.size() > 1) svg_.polyline(joined, "joined", colour_text(series.look.colour));
    for (const ResultRow* row : rows) {
      const double x = to_x(*rate_value(row, frame_.trio.across));
      const double y = to_y(*rate_value(row, frame_.trio.up));
      svg_.marker(x, y, series.look, point_hint(*row, frame_.trio));
      labels_.add_point(x, y);
      labels_.add_text(x, y, series.name, sweep_label(results, row->cell));
    }
    return !rows.empty();
  }

  /// What the points of sweeps were set to, when all are drawn.
  void draw_labels() { labels_.draw(svg_); }

  void say_empty() { svg_.text(x_ + kSide / 2.0, y_ + kSide / 2.0, "no result", "soft middle"); }

 private:
  /// At the upper edge, or at the right one if the line does not get there; not over another label.
  void label_iso_line(double level, double at_hundred) {
    const std::string text = length_text(level / 100.0 * frame_.trio.mean_unit);
    if (at_hundred < frame_.across.low) {
      if (at_hundred < frame_.up.low) return;  // It leaves the plot at the lower edge.
      svg_.text(x_ + kSide + 4.0, to_y(at_hundred) + 4.0, text, "soft");
    } else if (to_x(at_hundred) > last_label_ + 26.0) {
      last_label_ = to_x(at_hundred);
      svg_.text(last_label_, y_ - 6.0, text, "soft middle");
    }
  }
  [[nodiscard]] double to_x(double value) const { return x_ + frame_.across.at(value, kSide); }
  [[nodiscard]] double to_y(double value) const { return y_ + kSide - frame_.up.at(value, kSide); }

  SvgWriter& svg_;
  const Frame& frame_;
  double x_, y_;
  double last_label_ = -1e9;
  PointLabels labels_;
};

/// Axes that show every point; nothing if there is none.
std::optional<Frame> frame_of(const RunResults& results, const std::string& protocol) {
  const auto trio = rate_trio(results, protocol);
  if (!trio) return std::nullopt;
  double least_across = 100.0, least_up = 100.0;
  bool any = false;
  for (const ResultRow& row : results.rows) {
    const auto across = rate_value(&row, trio->across);
    const auto up = rate_value(&row, trio->up);
    if (row.protocol != protocol || row.control || !across || !up) continue;
    least_across = std::min(least_across, *across);
    least_up = std::min(least_up, *up);
    any = true;
  }
  if (!any) return std::nullopt;
  return Frame{*trio, axis_up_to(least_across, 100.0), axis_up_to(least_up, 100.0)};
}

/// Distance of neighbouring lines of equal mean, percent.
double iso_step(const Frame& frame) {
  const double span = std::max(100.0 - frame.up.low, 100.0 - frame.across.low);
  return span > 40.0 ? 10.0 : (span > 15.0 ? 5.0 : (span > 5.0 ? 2.0 : 0.5));
}

}  // namespace

std::string pr_rr_chart(const RunResults& results, const std::string& protocol, ChartPlace place) {
  const auto frame = frame_of(results, protocol);
  if (!frame) return "";
  const std::vector<ChartSeries> series = chart_series(results);
  const RateTrio& trio = frame->trio;
  const std::string title = trio.up + " against " + trio.across + " by protocol " + protocol;
  SvgWriter svg("rates-" + protocol, title,
                "A panel for each sequence, a marker for each method, dotted lines of equal " +
                    trio.mean + ". Up and right is better.");
  const std::size_t columns =
      std::min<std::size_t>(3, std::max<std::size_t>(1, results.sequences.size()));
  svg.text(16.0, 22.0, title + "; dotted: equal " + trio.mean, "bold");
  for (std::size_t i = 0; i < results.sequences.size(); ++i) {
    Panel panel(svg, *frame, kLeft + static_cast<double>(i % columns) * kPitch,
                kTop + static_cast<double>(i / columns) * kRowPitch);
    panel.draw_axes(results.sequences[i]);
    const double step = iso_step(*frame);
    for (double level = step; level < 100.0; level += step) panel.draw_iso_line(level);
    bool any = false;
    for (const ChartSeries& item : series) {
      any = panel.draw_series(item, results, results.sequences[i], protocol) || any;
    }
    panel.draw_labels();
    if (!any) panel.say_empty();
  }
  const double width =
      std::max(16.0 + std::max(1.0 * columns, 2.0) * kPitch,
               std::max(legend_width(series), text_width(title) * 1.1 + 130.0) + 32.0);
  const auto rows = static_cast<double>((results.sequences.size() + columns - 1) / columns);
  const double legend_top = kTop - 14.0 + rows * kRowPitch;
  const double legend = draw_legend(svg, series, 16.0, legend_top, width - 32.0);
  return svg.finish(width, legend_top + legend + 14.0, place);
}

}  // namespace raymoval
