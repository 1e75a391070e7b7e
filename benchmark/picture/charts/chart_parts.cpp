// SPDX-License-Identifier: MIT
#include "benchmark/picture/charts/chart_parts.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// What is swept over what, or the name of a cell that is no point of a sweep.
std::string series_name(const RunResults& results, const std::string& cell) {
  const SweptCell* point = results.swept(cell);
  return point == nullptr ? cell : point->sweep();
}

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

/// Where a text may stand beside its point, the best place first: from the point to its left or
/// right end (0: its middle), and to its base line.
constexpr std::pair<double, double> kLabelPlaces[] = {
    {8.0, 3.0},  {-8.0, 3.0},  {0.0, -9.0}, {0.0, 17.0},  {7.0, 14.0},  {-7.0, 14.0},
    {7.0, -8.0}, {-7.0, -8.0}, {8.0, 27.0}, {-8.0, 27.0}, {8.0, -20.0}, {-8.0, -20.0}};

}  // namespace

std::vector<ChartSeries> chart_series(const RunResults& results) {
  std::vector<ChartSeries> series;
  for (const std::string& cell : results.cells) {
    if (results.is_control(cell)) continue;
    const std::string name = series_name(results, cell);
    const auto known = std::find_if(series.begin(), series.end(),
                                    [&](const ChartSeries& item) { return item.name == name; });
    if (known != series.end()) {
      known->cells.push_back(cell);
    } else {
      series.push_back({name, {}, {cell}});
    }
  }
  for (std::size_t i = 0; i < series.size(); ++i) series[i].look = series_look(i, series.size());
  return series;
}

std::optional<double> ChartRates::harmonic_unit() const {
  if (!kept || !removed || !headline || !headline->formula) return std::nullopt;
  const RateFormula& formula = *headline->formula;
  const bool of_both = formula.first == kept->name && formula.second == removed->name;
  const bool percents = kept->unit == RateUnit::kPercent && removed->unit == RateUnit::kPercent;
  if (!of_both || !percents || formula.rule != "harmonic_mean") return std::nullopt;
  return headline->largest();
}

ChartRates chart_rates(const RunResults& results, const std::string& protocol) {
  ChartRates rates;
  for (const std::string& name : results.rates_of(protocol)) {
    const RateSpec spec = rate_spec(name);
    if (spec.role == RateRole::kKept && !rates.kept) rates.kept = spec;
    if (spec.role == RateRole::kRemoved && !rates.removed) rates.removed = spec;
    if (spec.role == RateRole::kHeadline && !rates.headline) rates.headline = spec;
  }
  return rates;
}

std::vector<double> LinearAxis::marks() const {
  std::vector<double> values;
  const double first = std::ceil(low / step - 1e-9);
  for (int i = 0; (first + i) * step <= high + 1e-9 * step; ++i)
    values.push_back((first + i) * step);
  return values;
}

LinearAxis axis_to_best(const RateSpec& rate, double worst) {
  const double end = rate.largest();
  const double span = std::max(std::abs(rate.best() - worst), 0.02 * end);
  LinearAxis axis{0.0, end, round_step(span / 3.0), !rate.higher_is_better};
  if (rate.higher_is_better) {
    axis.low = std::max(0.0, std::floor((worst - 0.03 * span) / axis.step) * axis.step);
  } else {
    axis.high = std::min(end, std::ceil((worst + 0.03 * span) / axis.step) * axis.step);
  }
  return axis;
}

LinearAxis axis_from_zero(double most) {
  const double end = most > 0.0 ? most : 1.0;
  LinearAxis axis{0.0, end, round_step(end / 3.0)};
  axis.high = std::ceil(end / axis.step - 1e-9) * axis.step;
  return axis;
}

LinearAxis axis_between(double low, double high) {
  const double step = round_step((high - low) / 3.0);
  return {std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step, step};
}

void draw_scales(ChartDrawing& chart, const LinearAxis& across, const LinearAxis& up,
                 const ChartPoint& corner, double side) {
  const double left = corner.x, right = left + side, top = corner.y, bottom = top + side;
  for (const double mark : across.marks()) {
    const double x = left + across.at(mark, side);
    chart.line(x, top, x, bottom, "grid");
    chart.text(x, bottom + 16.0, length_text(mark), "soft middle");
  }
  for (const double mark : up.marks()) {
    const double y = bottom - up.at(mark, side);
    chart.line(left, y, right, y, "grid");
    chart.text(left - 6.0, y + 4.0, length_text(mark), "soft end");
  }
  chart.polyline({{left, top}, {left, bottom}, {right, bottom}}, "axis");
}

std::string axis_title(const RateSpec& rate) {
  return rate.name + (rate.unit == RateUnit::kPercent ? ", %" : "");
}

std::string sweep_label(const RunResults& results, const std::string& cell) {
  const SweptCell* point = results.swept(cell);
  if (point == nullptr) return "";
  std::vector<std::string> values;
  for (const auto& [key, value] : point->values) values.push_back(value);
  return join(values);
}

void PointLabels::add_point(double x, double y) {
  points_.emplace_back(x, y);
}

void PointLabels::add_text(double x, double y, const std::string& series, const std::string& text) {
  if (text.empty()) return;
  for (Text& known : texts_) {
    if (known.series != series || std::hypot(known.x - x, known.y - y) > 4.0) continue;
    known.parts.push_back(text);
    return;
  }
  texts_.push_back({x, y, series, {text}});
}

void PointLabels::draw(ChartDrawing& chart) const {
  // What is far outside counts as taken.
  constexpr double kFar = 1e5;
  std::vector<Box> taken = {
      {-kFar, -kFar, left_, kFar}, {right_, -kFar, kFar, kFar}, {-kFar, -kFar, kFar, top_}};
  for (const auto& [x, y] : points_) taken.push_back({x - 6.0, y - 6.0, x + 6.0, y + 6.0});
  for (const Text& text : texts_) {
    const std::size_t count = text.parts.size();
    const std::string shown =
        count > 4 ? text.parts.front() + " ... " + text.parts.back() : join(text.parts);
    const double width = text_width(shown) * 10.0 / 12.0;
    Box best{};
    double least = 1e18;
    for (const auto& [dx, dy] : kLabelPlaces) {
      const double left = text.x + (dx > 0.0 ? dx : dx < 0.0 ? dx - width : -width / 2.0);
      const Box box{left, text.y + dy - 8.0, left + width, text.y + dy + 2.0};
      double covered = 0.0;
      for (const Box& other : taken) covered += box.common_area(other);
      if (covered >= least) continue;
      least = covered;
      best = box;
    }
    chart.text(best.left, best.bottom - 2.0, shown, "small");
    taken.push_back(best);
  }
}

double legend_width(const std::vector<ChartSeries>& series) {
  double column = 60.0;
  for (const ChartSeries& item : series) column = std::max(column, text_width(item.name) + 32.0);
  return column;
}

double draw_legend(ChartDrawing& chart, const std::vector<ChartSeries>& series, double x, double y,
                   double width) {
  constexpr double kRow = 20.0;
  const double column = legend_width(series);
  const auto columns = static_cast<std::size_t>(std::max(1.0, std::floor(width / column)));
  for (std::size_t i = 0; i < series.size(); ++i) {
    const double left = x + static_cast<double>(i % columns) * column;
    const double top = y + static_cast<double>(i / columns) * kRow;
    chart.marker(left + 7.0, top + 8.0, series[i].look, series[i].name);
    chart.text(left + 19.0, top + 12.0, series[i].name);
  }
  return kRow * static_cast<double>((series.size() + columns - 1) / columns);
}

}  // namespace raymoval
