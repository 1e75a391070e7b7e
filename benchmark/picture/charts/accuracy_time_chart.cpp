// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "benchmark/picture/charts/chart_parts.h"
#include "core/text.h"
#include "eval/averages.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr double kPlotWidth = 460.0;
constexpr double kPlotHeight = 330.0;
constexpr double kPlotLeft = 64.0;
constexpr double kPlotTop = 48.0;
constexpr double kPlotRight = kPlotLeft + kPlotWidth;
constexpr double kPlotBottom = kPlotTop + kPlotHeight;
constexpr std::size_t kMost = 30;  ///< Names in the list beside the plot before it gets longer.

/// A method in the plane of time and accuracy.
struct Spot {
  std::string cell;
  std::string point;  ///< What it was set to, if it is a point of a sweep.
  SeriesLook look;
  double ms = 0.0;
  double accuracy = 0.0;
  std::size_t sequences = 0;  ///< That have a value.
};

std::vector<Spot> spots_of(const RunResults& results, const std::string& protocol,
                           const RateSpec& rate) {
  std::vector<Spot> spots;
  for (const ChartSeries& series : chart_series(results)) {
    for (const std::string& cell : series.cells) {
      const Mean mean = mean_of(results.values(cell, protocol, rate.name));
      const auto ms = results.ms_per_scan(cell);
      if (mean.value && ms && *ms > 0.0)
        spots.push_back(
            {cell, sweep_label(results, cell), series.look, *ms, *mean.value, mean.segments});
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

/// Time to the right by its logarithm, accuracy upwards.
class Plot {
 public:
  /// @param spots the most accurate one first
  Plot(ChartDrawing& chart, const std::vector<Spot>& spots, const RateSpec& rate)
      : chart_(chart), spots_(spots), rate_(rate) {
    double from = spots.front().ms, to = from;
    for (const Spot& spot : spots) {
      from = std::min(from, spot.ms);
      to = std::max(to, spot.ms);
    }
    up_ = axis_to_best(rate, spots.back().accuracy);
    low_ = std::floor(std::log10(from) - 0.02);
    high_ = std::max(low_ + 1.0, std::ceil(std::log10(to) + 0.02));
  }

  void draw_axes() {
    for (const double mark : up_.marks()) {
      chart_.line(kPlotLeft, to_y(mark), kPlotRight, to_y(mark), "grid");
      chart_.text(kPlotLeft - 6.0, to_y(mark) + 4.0, length_text(mark), "soft end");
    }
    for (double power = low_; power <= high_; power += 1.0) {
      const double x = to_x(std::pow(10.0, power));
      chart_.line(x, kPlotTop, x, kPlotBottom, "grid");
      chart_.text(x, kPlotBottom + 16.0, length_text(std::pow(10.0, power)), "soft middle");
    }
    chart_.polyline({{kPlotLeft, kPlotTop}, {kPlotLeft, kPlotBottom}, {kPlotRight, kPlotBottom}},
                    "axis");
    chart_.text(kPlotLeft + kPlotWidth / 2.0, kPlotBottom + 34.0, "ms per scan (log scale)",
                "middle");
    chart_.text_upwards(18.0, kPlotTop + kPlotHeight / 2.0, "mean " + rate_.name);
  }

  /// Joins the methods than which none is both faster and more accurate.
  void draw_front() {
    std::vector<const Spot*> order;
    for (const Spot& spot : spots_) order.push_back(&spot);
    std::stable_sort(order.begin(), order.end(),
                     [](const Spot* a, const Spot* b) { return a->ms < b->ms; });
    std::vector<ChartPoint> points;
    std::optional<double> best;
    for (const Spot* spot : order) {
      if (best && !rate_.is_better(spot->accuracy, *best)) continue;
      if (best) points.push_back({to_x(spot->ms), to_y(*best)});
      best = spot->accuracy;
      points.push_back({to_x(spot->ms), to_y(*best)});
    }
    chart_.polyline(points, "front");
  }

  void draw_markers() {
    for (const Spot& spot : spots_) {
      chart_.marker(to_x(spot.ms), to_y(spot.accuracy), spot.look,
                    spot.cell + ": mean " + rate_.name + " " +
                        rate_text(rate_.name, spot.accuracy) + ", " + time_text(spot.ms) +
                        " per scan");
    }
    PointLabels labels(kPlotLeft, kPlotRight + 20.0, kPlotTop - 6.0);
    for (const Spot& spot : spots_) {
      labels.add_point(to_x(spot.ms), to_y(spot.accuracy));
      labels.add_text(to_x(spot.ms), to_y(spot.accuracy), colour_text(spot.look.colour),
                      spot.point);
    }
    labels.draw(chart_);
  }

 private:
  [[nodiscard]] double to_x(double ms) const {
    return kPlotLeft + (std::log10(ms) - low_) / (high_ - low_) * kPlotWidth;
  }
  [[nodiscard]] double to_y(double value) const { return kPlotBottom - up_.at(value, kPlotHeight); }

  ChartDrawing& chart_;
  const std::vector<Spot>& spots_;
  const RateSpec& rate_;
  LinearAxis up_;
  double low_ = 0.0, high_ = 1.0;
};

/// The methods beside the plot, best first. @return width and height
std::pair<double, double> draw_list(ChartDrawing& chart, const std::vector<Spot>& spots,
                                    const std::string& rate, std::size_t of) {
  const double x = kPlotRight + 34.0;
  double name_width = 60.0;
  for (const Spot& spot : spots) name_width = std::max(name_width, text_width(spot.cell));
  const double row = spots.size() > kMost ? 15.0 : 19.0;
  double y = kPlotTop + 8.0;
  for (const Spot& spot : spots) {
    chart.marker(x, y - 4.0, spot.look, spot.cell);
    chart.text(x + 13.0, y, spot.cell);
    chart.text(x + name_width + 66.0, y, rate_text(rate, spot.accuracy), "ink end");
    chart.text(x + name_width + 138.0, y, time_text(spot.ms), "soft end");
    if (spot.sequences < of) {
      chart.text(x + name_width + 146.0, y,
                 "(" + std::to_string(spot.sequences) + "/" + std::to_string(of) + ")", "soft");
    }
    y += row;
  }
  return {x + name_width + 196.0, y};
}

}  // namespace

ChartDrawing accuracy_time_chart(const RunResults& results, const std::string& protocol) {
  const std::optional<RateSpec> rate = chart_rates(results, protocol).headline;
  if (!rate) return {};
  const std::vector<Spot> spots = spots_of(results, protocol, *rate);
  if (spots.empty()) return {};
  const std::string title = "Accuracy against time by protocol " + protocol;
  ChartDrawing chart("accuracy-time-" + protocol, title,
                     "A marker for each method: mean " + rate->name +
                         " over the sequences upwards, milliseconds per scan to the right. The "
                         "line joins the methods that no other one beats in both.");
  chart.text(16.0, 22.0, title, "bold");
  Plot plot(chart, spots, *rate);
  plot.draw_axes();
  plot.draw_front();
  plot.draw_markers();
  const auto [width, list_end] = draw_list(chart, spots, rate->name, results.sequences.size());
  chart.set_size(width, std::max(kPlotBottom + 48.0, list_end + 10.0));
  return chart;
}

}  // namespace raymoval
