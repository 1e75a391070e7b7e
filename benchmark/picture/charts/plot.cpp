// SPDX-License-Identifier: MIT
#include "benchmark/picture/charts/plot.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// The largest of 1, 2 and 5 times a power of ten that is not above `value`.
double round_step(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double digit = value / power;
  return power * (digit >= 5.0 ? 5.0 : (digit >= 2.0 ? 2.0 : 1.0));
}

struct Box {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;

  [[nodiscard]] double common_area(const Box& other) const {
    const double width = std::min(right, other.right) - std::max(left, other.left);
    const double height = std::min(bottom, other.bottom) - std::max(top, other.top);
    return width > 0.0 && height > 0.0 ? width * height : 0.0;
  }
};

/// Positions of a label beside its point, the best first: from the point to the label's left or
/// right end (0: its middle), and to its baseline.
constexpr std::pair<double, double> kLabelPlaces[] = {
    {8.0, 3.0},  {-8.0, 3.0},  {0.0, -9.0}, {0.0, 17.0},  {7.0, 14.0},  {-7.0, 14.0},
    {7.0, -8.0}, {-7.0, -8.0}, {8.0, 27.0}, {-8.0, 27.0}, {8.0, -20.0}, {-8.0, -20.0}};

/// The position beside `at` that covers the least area of `taken`.
Box label_box(const ChartPoint& at, double width, const std::vector<Box>& taken) {
  Box best{};
  double least = 1e18;
  for (const auto& [dx, dy] : kLabelPlaces) {
    const double left = at.x + (dx > 0.0 ? dx : dx < 0.0 ? dx - width : -width / 2.0);
    const Box box{left, at.y + dy - 8.0, left + width, at.y + dy + 2.0};
    double covered = 0.0;
    for (const Box& other : taken) covered += box.common_area(other);
    if (covered >= least) continue;
    least = covered;
    best = box;
  }
  return best;
}

}  // namespace

std::vector<ChartSeries> chart_series(const RunResults& results) {
  std::vector<ChartSeries> series;
  for (const std::string& cell : results.methods) {
    if (results.is_control(cell)) continue;
    const SweptCell* point = results.swept(cell);
    const std::string name = point == nullptr ? cell : point->sweep();
    auto known = std::ranges::find(series, name, &ChartSeries::name);
    if (known == series.end()) known = series.insert(known, {name, {}, {}});
    known->cells.push_back(cell);
  }
  for (std::size_t i = 0; i < series.size(); ++i) series[i].look = series_style(i, series.size());
  return series;
}

ChartRates::ChartRates(const RunResults& results, const std::string& protocol) {
  for (const std::string& name : results.rates_of(protocol)) {
    const RateSpec spec = rate_spec(name);
    if (spec.role == RateRole::kKept && !kept) kept = spec;
    if (spec.role == RateRole::kRemoved && !removed) removed = spec;
    if (spec.role == RateRole::kHeadline && !headline) headline = spec;
  }
}

std::string sweep_label(const RunResults& results, const std::string& cell) {
  const SweptCell* point = results.swept(cell);
  if (point == nullptr) return "";
  std::vector<std::string> values;
  for (const auto& [key, value] : point->values) values.push_back(value);
  return join(values);
}

double Axis::at(double value, double length) const {
  const double place = logarithmic ? std::log10(value) : value;
  return (reversed ? high - place : place - low) / (high - low) * length;
}

std::vector<double> Axis::marks() const {
  std::vector<double> values;
  const double first = std::ceil(low / step - 1e-9);
  for (int i = 0; (first + i) * step <= high + 1e-9 * step; ++i) {
    const double place = (first + i) * step;
    values.push_back(logarithmic ? std::pow(10.0, place) : place);
  }
  return values;
}

Axis axis_to_best(const RateSpec& rate, double worst) {
  const double end = rate.largest();
  const double span = std::max(std::abs(rate.best() - worst), 0.02 * end);
  Axis axis{0.0, end, round_step(span / 3.0), !rate.higher_is_better};
  if (rate.higher_is_better) {
    axis.low = std::max(0.0, std::floor((worst - 0.03 * span) / axis.step) * axis.step);
  } else {
    axis.high = std::min(end, std::ceil((worst + 0.03 * span) / axis.step) * axis.step);
  }
  return axis;
}

Axis axis_between(double low, double high) {
  const double step = round_step((high - low) / 3.0);
  return {std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step, step};
}

std::string axis_title(const RateSpec& rate) {
  return rate.name + (rate.unit == RateUnit::kPercent ? ", %" : "") +
         (rate.higher_is_better ? " (higher is better)" : " (lower is better)");
}

Plot::Plot(Chart& chart, const ChartPoint& corner, const ChartPoint& size, const Axis& across,
           const Axis& up, const std::string& across_title, const std::string& up_title)
    : chart_(chart), corner_(corner), size_(size), across_(across), up_(up) {
  const double left = corner.x, right = left + size.x, top = corner.y, bottom = top + size.y;
  for (const double mark : across.marks()) {
    const double x = left + across.at(mark, size.x);
    chart.line({{x, top}, {x, bottom}}, "grid");
    chart.text(x, bottom + 16.0, length_text(mark), "soft middle");
  }
  for (const double mark : up.marks()) {
    const double y = bottom - up.at(mark, size.y);
    chart.line({{left, y}, {right, y}}, "grid");
    chart.text(left - 6.0, y + 4.0, length_text(mark), "soft end");
  }
  chart.line({{left, top}, {left, bottom}, {right, bottom}}, "axis");
  chart.text(left + size.x / 2.0, bottom + 32.0, across_title, "middle");
  if (!up_title.empty()) chart.text_upwards(left - 40.0, top + size.y / 2.0, up_title);
}

ChartPoint Plot::at(double x, double y) const {
  return {corner_.x + across_.at(x, size_.x), corner_.y + size_.y - up_.at(y, size_.y)};
}

void Plot::draw_series(const ChartSeries& series, const std::vector<PlotPoint>& points,
                       bool joined) {
  std::vector<ChartPoint> places;
  for (const PlotPoint& point : points) places.push_back(at(point.x, point.y));
  if (joined && places.size() > 1) chart_.line(places, "joined", series.look.colour);
  for (std::size_t i = 0; i < points.size(); ++i) {
    chart_.marker(places[i], series.look, points[i].hint);
    points_.push_back(places[i]);
    if (!points[i].label.empty()) add_label(places[i], series.name, points[i].label);
  }
}

void Plot::add_label(const ChartPoint& at, const std::string& series, const std::string& text) {
  for (Label& known : labels_) {
    if (known.series != series || std::hypot(known.at.x - at.x, known.at.y - at.y) > 4.0) continue;
    known.parts.push_back(text);
    return;
  }
  labels_.push_back({at, series, {text}});
}

void Plot::draw_labels() const {
  // The area far outside counts as taken.
  constexpr double kFar = 1e5;
  std::vector<Box> taken = {{-kFar, -kFar, corner_.x - 30.0, kFar},
                            {corner_.x + size_.x + 30.0, -kFar, kFar, kFar},
                            {-kFar, -kFar, kFar, corner_.y - 6.0}};
  for (const auto& [x, y] : points_) taken.push_back({x - 6.0, y - 6.0, x + 6.0, y + 6.0});
  for (const Label& label : labels_) {
    const std::string text = label.parts.size() > 4
                                 ? label.parts.front() + " ... " + label.parts.back()
                                 : join(label.parts);
    const Box box = label_box(label.at, text_width(text) * 10.0 / 12.0, taken);
    chart_.text(box.left, box.bottom - 2.0, text, "small");
    taken.push_back(box);
  }
}

void finish_with_legend(Chart& chart, const std::vector<ChartSeries>& series, double top,
                        double width) {
  constexpr double kRow = 20.0, kMargin = 16.0;
  double column = 60.0;
  for (const ChartSeries& item : series) column = std::max(column, text_width(item.name) + 32.0);
  width = std::max(width, column + 2.0 * kMargin);
  const auto columns =
      static_cast<std::size_t>(std::max(1.0, std::floor((width - 2.0 * kMargin) / column)));
  for (std::size_t i = 0; i < series.size(); ++i) {
    const double x = kMargin + static_cast<double>(i % columns) * column;
    const double y = top + static_cast<double>(i / columns) * kRow;
    chart.marker({x + 7.0, y + 8.0}, series[i].look, series[i].name);
    chart.text(x + 19.0, y + 12.0, series[i].name);
  }
  const auto rows = static_cast<double>((series.size() + columns - 1) / columns);
  chart.set_size(width, top + rows * kRow + 14.0);
}

}  // namespace raymoval
