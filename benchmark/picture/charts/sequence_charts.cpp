// SPDX-License-Identifier: MIT
// The charts of one sequence: rates with their intervals; shares of points by range, time, class.
#include <algorithm>

#include "benchmark/picture/charts/charts.h"
#include "benchmark/picture/charts/plot.h"
#include "benchmark/tables/tables.h"
#include "core/text.h"
#include "eval/columns/columns.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr double kPlotWidth = 230.0, kPlotHeight = 180.0;
constexpr double kPlotGap = 74.0;  ///< Between neighbouring plots.
constexpr double kLeft = 56.0, kTop = 76.0;

/// The value of a series in a row, with its interval if it has one.
struct RowValue {
  double row = 0.0;  ///< Its place: 0 is the middle of the first row, 1 that of the second.
  SeriesStyle look;
  double value = 0.0;
  const Interval* interval = nullptr;
  std::string hint;
};

/// Rows of values below each other, each with a name to the left of the plot.
struct RowPlot {
  std::vector<std::string> names;
  std::vector<RowValue> values;
  RateSpec rate;  ///< Of all values.
  std::string title;

  [[nodiscard]] double label_width() const {
    double width = 0.0;
    for (const std::string& name : names) width = std::max(width, text_width(name));
    return width + 10.0;
  }

  [[nodiscard]] Axis axis() const {
    double worst = rate.best();
    for (const RowValue& value : values) {
      if (rate.is_better(worst, value.value)) worst = value.value;
      if (value.interval == nullptr) continue;
      for (const auto& end : {value.interval->low, value.interval->high}) {
        if (rate.is_better(worst, *end)) worst = *end;
      }
    }
    return axis_to_best(rate, worst);
  }

  void draw(Chart& chart, const ChartPoint& corner, const ChartPoint& size, bool with_names) const {
    const auto rows = static_cast<double>(names.size());
    // The rows' own axis has no marks.
    const Plot plot(chart, corner, size, axis(), {0.5, rows + 0.5, rows + 2.0}, title, "");
    for (std::size_t row = 0; row < names.size(); ++row) {
      const double top = corner.y + static_cast<double>(row) / rows * size.y;
      chart.line({{corner.x, top}, {corner.x + size.x, top}}, "grid");
      if (with_names) {
        chart.text(corner.x - 8.0, top + size.y / rows / 2.0 + 4.0, names[row], "end");
      }
    }
    for (const RowValue& value : values) {
      const double up = rows - value.row;
      if (value.interval != nullptr) {
        chart.line({plot.at(*value.interval->low, up), plot.at(*value.interval->high, up)}, "bar",
                   value.look.colour);
      }
      chart.marker(plot.at(value.value, up), value.look, value.hint);
    }
  }
};

std::string rate_hint(const std::string& method, const RateSpec& rate, double value,
                      const Interval* interval) {
  std::string hint = method + ": " + rate.name + " " + rate_text(rate.name, value);
  if (interval == nullptr) return hint;
  return hint + ", interval " + rate_text(rate.name, *interval->low) + " to " +
         rate_text(rate.name, *interval->high);
}

/// A method on a sequence.
struct Entry {
  std::string method;
  SeriesStyle look;
  const Cell* cell = nullptr;
};

/// The methods with a result, controls left out.
std::vector<Entry> entries_of(const RunResults& results, const std::string& sequence) {
  std::vector<Entry> entries;
  for (const ChartSeries& series : chart_series(results)) {
    for (const std::string& method : series.cells) {
      const Cell* cell = results.find(sequence, method);
      if (cell != nullptr && cell->ok()) entries.push_back({method, series.look, cell});
    }
  }
  return entries;
}

/// A share of points as a rate in percent.
RateSpec share_rate(const std::string& name) {
  RateSpec rate;
  rate.name = name;
  return rate;
}

/// The columns of one kind, for all methods on a sequence.
struct Parts {
  std::vector<Entry> entries;  ///< With columns.
  std::string kind;            ///< `ColumnName::kind`.
  std::string points, answer;  ///< "moving points", "removed".

  /// The share of a part with at least `kNamedClassPoints` points.
  [[nodiscard]] std::optional<double> share(const Entry& entry, const std::string& column) const {
    const Share share = entry.cell->columns->find(column);
    return share.whole < kNamedClassPoints ? std::nullopt : share.percent();
  }

  [[nodiscard]] std::string hint(const Entry& entry, const std::string& part,
                                 double percent) const {
    return entry.method + ", " + part + ": " + fixed_text(percent, 2) + " % of " + points + " " +
           answer;
  }

  /// Draws a line for each method over bands. @return false if there is no value
  bool draw_bands(Chart& chart, const ChartPoint& corner, const std::string& axis,
                  const std::vector<std::string>& bands, double width,
                  const std::string& title) const {
    const RateSpec rate = share_rate(kind);
    double worst = rate.best();
    std::vector<std::vector<PlotPoint>> lines;
    for (const Entry& entry : entries) {
      std::vector<PlotPoint>& line = lines.emplace_back();
      for (std::size_t i = 0; i < bands.size(); ++i) {
        const auto percent = share(entry, ColumnName{kind, "", axis, bands[i]}.text());
        if (!percent) continue;
        worst = std::min(worst, *percent);
        const double middle = (static_cast<double>(i) + 0.5) * width;
        line.push_back({middle, *percent, hint(entry, axis + " " + bands[i], *percent)});
      }
    }
    if (std::ranges::all_of(lines, [](const auto& line) { return line.empty(); })) return false;
    const double end = width * static_cast<double>(bands.size());
    Plot plot(chart, corner, {kPlotWidth, kPlotHeight}, axis_between(0.0, end),
              axis_to_best(rate, worst), title, "%");
    for (std::size_t i = 0; i < entries.size(); ++i) {
      plot.draw_series({entries[i].method, entries[i].look, {}}, lines[i], true);
    }
    return true;
  }

  /// Rows of classes, in which the methods are below each other.
  [[nodiscard]] RowPlot classes() const {
    RowPlot rows{{}, {}, share_rate(kind), "class, %"};
    const auto count = static_cast<double>(entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const double offset = (static_cast<double>(i) - (count - 1.0) / 2.0) / (count + 1.0);
      for (const ColumnValue& column : entries[i].cell->columns->values) {
        const ColumnName name = parse_column_name(column.name);
        const auto percent = share(entries[i], column.name);
        if (name.kind != kind || name.group.empty() || !name.axis.empty() || !percent) continue;
        add_once(rows.names, name.group);
        const auto row = std::ranges::find(rows.names, name.group) - rows.names.begin();
        rows.values.push_back({static_cast<double>(row) + offset, entries[i].look, *percent,
                               nullptr, hint(entries[i], name.group, *percent)});
      }
    }
    return rows;
  }
};

template <std::size_t Count>
std::vector<std::string> band_names(std::string (*name)(std::size_t)) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < Count; ++i) names.push_back(name(i));
  return names;
}

/// Draws the plots of `parts` from `top` down. @return the bottom; `top` if there is no value
double draw_parts(Chart& chart, const Parts& parts, double top, double& width) {
  const RowPlot classes = parts.classes();
  double left = kLeft;
  for (const bool by_range : {true, false}) {
    const bool drawn = by_range ? parts.draw_bands(chart, {left, top}, "range",
                                                   band_names<kRangeBands>(range_band_name), 10.0,
                                                   "range, m (last: 50 and more)")
                                : parts.draw_bands(chart, {left, top}, "time",
                                                   band_names<kTimeBands>(time_band_name),
                                                   100.0 / kTimeBands, "time, % of the scans");
    if (drawn) left += kPlotWidth + kPlotGap;
  }
  double height = kPlotHeight;
  if (!classes.values.empty()) {
    const double pitch =
        std::clamp(8.0 + 5.0 * static_cast<double>(parts.entries.size()), 18.0, 60.0);
    height = std::max(height, pitch * static_cast<double>(classes.names.size()));
    left += classes.label_width() - kPlotGap + 30.0;
    classes.draw(chart, {left, top}, {kPlotWidth, height}, true);
    left += kPlotWidth + kPlotGap;
  }
  if (left == kLeft) return top;
  chart.text(16.0, top - 14.0,
             "Share of " + parts.points + " that are " + parts.answer + " (higher is better)",
             "bold");
  width = std::max(width, left - kPlotGap + 30.0);
  return top + height + 80.0;
}

}  // namespace

Chart interval_chart(const RunResults& results, const std::string& protocol,
                     const std::string& sequence) {
  const ChartRates rates(results, protocol);
  std::vector<Entry> entries = entries_of(results, sequence);
  std::erase_if(entries, [&](const Entry& entry) {
    const Score* score = entry.cell->score(protocol);
    return score == nullptr || !rates.headline || score->interval(rates.headline->name) == nullptr;
  });
  if (entries.empty()) return {};
  const auto headline = [&](const Entry& entry) {
    return entry.cell->score(protocol)->rate(rates.headline->name).value_or(0.0);
  };
  std::ranges::stable_sort(entries, [&](const Entry& a, const Entry& b) {
    return rates.headline->is_better(headline(a), headline(b));
  });
  Chart chart("intervals-" + protocol + "-" + sequence,
              "Rates by protocol " + protocol + " with 95 % intervals",
              "A row for each method, the best first: a marker at the rate, a bar over its "
              "interval. Methods whose bars overlap may change places on other scans.");
  double left = 16.0;
  const double height = 26.0 * static_cast<double>(entries.size());
  for (const auto& rate : {rates.headline, rates.kept, rates.removed}) {
    if (!rate) continue;
    RowPlot plot{{}, {}, *rate, axis_title(*rate)};
    for (const Entry& entry : entries) {
      const Score& score = *entry.cell->score(protocol);
      const auto value = score.rate(rate->name);
      const Interval* interval = score.interval(rate->name);
      if (value) {
        plot.values.push_back({static_cast<double>(plot.names.size()), entry.look, *value, interval,
                               rate_hint(entry.method, *rate, *value, interval)});
      }
      plot.names.push_back(entry.method);
    }
    const bool first = left == 16.0;
    if (first) left += plot.label_width();
    plot.draw(chart, {left, 44.0}, {kPlotWidth, height}, first);
    left += kPlotWidth + 40.0;
  }
  chart.set_size(left - 10.0, 44.0 + height + 46.0);
  return chart;
}

Chart parts_chart(const RunResults& results, const std::string& sequence) {
  std::vector<Entry> entries = entries_of(results, sequence);
  std::erase_if(entries, [](const Entry& entry) { return !entry.cell->columns; });
  Chart chart("parts-" + sequence, "Points by range, time and class",
              "Above the share of moving points that are removed, below the share of static points "
              "that are kept: lines over range and over time, rows of classes. Parts with fewer "
              "than 100 points are left out.");
  double width = 0.0, top = kTop;
  top = draw_parts(chart, {entries, "rejection", "moving points", "removed"}, top, width);
  top = draw_parts(chart, {entries, "preservation", "static points", "kept"}, top, width);
  if (top == kTop) return {};
  std::vector<ChartSeries> legend = chart_series(results);
  std::erase_if(legend, [&](const ChartSeries& series) {
    return std::ranges::none_of(series.cells, [&](const std::string& cell) {
      return std::ranges::find(entries, cell, &Entry::method) != entries.end();
    });
  });
  finish_with_legend(chart, legend, top - 30.0, width);
  return chart;
}

}  // namespace raymoval
