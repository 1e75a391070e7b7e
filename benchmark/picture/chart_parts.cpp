// SPDX-License-Identifier: MIT
#include "benchmark/picture/chart_parts.h"

#include <algorithm>
#include <cmath>

namespace raymoval {
namespace {

/// What a sweep is of, and over what; the cell itself if it is none of a sweep.
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
      series.push_back({name, series_look(series.size()), {cell}});
    }
  }
  return series;
}

std::optional<RateTrio> rate_trio(const RunResults& results, const std::string& protocol) {
  for (const RateTrio& trio :
       {RateTrio{"RR", "PR", "F1", 1.0}, RateTrio{"DA", "SA", "HA", 100.0}}) {
    for (const ResultRow& row : results.rows) {
      if (row.protocol == protocol && row.rates.count(trio.up) > 0 &&
          row.rates.count(trio.across) > 0) {
        return trio;
      }
    }
  }
  return std::nullopt;
}

std::optional<double> rate_value(const ResultRow* row, const std::string& rate) {
  if (row == nullptr || row->status != "ok") return std::nullopt;
  const auto found = row->rates.find(rate);
  return found == row->rates.end() ? std::nullopt : found->second;
}

std::vector<double> LinearAxis::marks() const {
  std::vector<double> values;
  const double first = std::ceil(low / step - 1e-9);
  for (int i = 0; (first + i) * step <= high + 1e-9 * step; ++i)
    values.push_back((first + i) * step);
  return values;
}

LinearAxis axis_up_to(double least, double high) {
  const double span = std::max(high - least, 0.02 * high);
  LinearAxis axis{0.0, high, round_step(span / 3.0)};
  axis.low = std::max(0.0, std::floor((least - 0.03 * span) / axis.step) * axis.step);
  return axis;
}

LinearAxis axis_from_zero(double most) {
  const double end = most > 0.0 ? most : 1.0;
  LinearAxis axis{0.0, end, round_step(end / 3.0)};
  axis.high = std::ceil(end / axis.step - 1e-9) * axis.step;
  return axis;
}

double draw_legend(SvgWriter& svg, const std::vector<ChartSeries>& series, double x, double y,
                   double width) {
  constexpr double kRow = 20.0;
  double column = 60.0;
  for (const ChartSeries& item : series) column = std::max(column, text_width(item.name) + 32.0);
  const auto columns = static_cast<std::size_t>(std::max(1.0, std::floor(width / column)));
  for (std::size_t i = 0; i < series.size(); ++i) {
    const double left = x + static_cast<double>(i % columns) * column;
    const double top = y + static_cast<double>(i / columns) * kRow;
    svg.marker(left + 7.0, top + 8.0, series[i].look, series[i].name);
    svg.text(left + 19.0, top + 12.0, series[i].name);
  }
  return kRow * static_cast<double>((series.size() + columns - 1) / columns);
}

}  // namespace raymoval
