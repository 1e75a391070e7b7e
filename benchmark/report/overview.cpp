// SPDX-License-Identifier: MIT
// The parts of a report about methods and cells as a whole.
#include <algorithm>

#include "benchmark/picture/charts/charts.h"
#include "benchmark/picture/charts/plot.h"
#include "benchmark/report/sections.h"
#include "benchmark/tables/tables.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

TableCell mean_over_sequences(const RunResults& results, const std::string& cell,
                              const std::string& protocol, const std::string& rate) {
  return mean_cell({}, rate, mean_of(results.values(cell, protocol, rate)),
                   results.sequences.size());
}

std::string chart_html(const Chart& chart) {
  return chart.empty() ? ""
                       : "<div class=\"chart\" style=\"--width:" + length_text(chart.width()) +
                             "px\">" + chart.svg("") + "</div>\n";
}

/// "By erasor, PR is the share of static points or voxels that are kept, ...": the main rates.
std::string meaning_text(const RunResults& results, const std::string& protocol) {
  const ChartRates rates(results, protocol);
  std::vector<std::string> parts;
  const auto add = [&](const std::optional<RateSpec>& rate, const std::string& points,
                       const char* good, const char* bad) {
    if (!rate) return;
    parts.push_back(rate->name + " is the share of " + points + " points or voxels that " +
                    (rate->higher_is_better ? good : bad));
  };
  add(rates.kept, "static", "are kept", "are lost");
  add(rates.removed, "moving", "are removed", "stay");
  if (rates.headline) parts.push_back(rates.headline->name + " is both in one number");
  return "By " + protocol + ", " + join(parts) + ".";
}

/// A method with its mean headline rate, and its time if that is known.
struct Choice {
  std::string method;
  double accuracy = 0.0;
  std::optional<double> ms;

  [[nodiscard]] std::string text(const std::string& rate) const {
    return html_name(method) + " (" + rate + " " + rate_text(rate, accuracy) +
           (ms ? ", " + ms_text(*ms) + " per scan" : "") + ")";
  }
};

/// Where a method fails: the sequence with its worst rate, and the classes that it loses.
std::string weakness_text(const RunResults& results, const std::string& method,
                          const std::string& protocol, const RateSpec& rate) {
  std::string text;
  const SegmentValues values = results.values(method, protocol, rate.name);
  std::size_t worst = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] && (!values[worst] || rate.is_better(*values[worst], *values[i]))) worst = i;
  }
  if (values.size() > 1 && values[worst]) {
    text += " Its worst sequence is " + results.sequences[worst] + " (" +
            rate_text(rate.name, *values[worst]) + ").";
  }
  const MethodColumns* columns = results.columns_of(method);
  if (columns == nullptr) return text;
  for (const bool moves : {true, false}) {
    const auto lost = worst_class(*columns, moves ? "rejection" : "preservation");
    if (!lost) continue;
    text += std::string(" Its worst ") + (moves ? "moving" : "static") + " class is " + lost->name +
            ", " + fixed_text(lost->percent, 3) + " % " + (moves ? "removed." : "kept.");
  }
  return text;
}

/// The best method, where it fails, and methods that are faster.
std::string choice_html(const RunResults& results) {
  if (results.protocols.empty()) return "";
  const std::string protocol = results.protocols.front();
  const std::optional<RateSpec> rate = ChartRates(results, protocol).headline;
  std::vector<Choice> choices;  // Each is faster than those before it.
  for (const std::string& method : methods_best_first(results)) {
    if (!rate || results.is_control(method)) continue;
    const Mean mean = mean_of(results.values(method, protocol, rate->name));
    const auto ms = results.ms_per_scan(method);
    if (!mean.value || mean.segments < results.sequences.size()) continue;
    if (choices.empty() || (ms && choices.back().ms && *ms < *choices.back().ms)) {
      choices.push_back({method, *mean.value, ms});
    }
  }
  if (choices.empty()) return "";
  std::string html = "<p>Best: <strong>" + choices.front().text(rate->name) + "</strong>." +
                     html_text(weakness_text(results, choices.front().method, protocol, *rate));
  for (std::size_t i = 1; i < choices.size(); ++i) {
    html += (i == 1 ? " Faster: " : ", ") + choices[i].text(rate->name);
  }
  return html + (choices.size() > 1 ? ".</p>\n" : "</p>\n");
}

}  // namespace

std::string facts_html(const ResultsRecord& record, const RunResults& results) {
  std::size_t scans = 0;
  for (const SequenceRecord& sequence : record.run.sequences) scans += sequence.data.scans;
  const auto bad = [](const std::string& text) {
    return "<strong class=\"bad\">" + text + "</strong> ";
  };
  std::string html = "<p>" + counted_text(results.methods.size(), "method") +
                     ", controls included, on " +
                     counted_text(results.sequences.size(), "sequence") + " with " +
                     counted_text(scans, "scan") + ". ";
  const auto failed = std::ranges::count_if(results.cells, [](auto& cell) { return !cell.ok(); });
  if (failed > 0)
    html += bad(counted_text(static_cast<std::size_t>(failed), "failed cell") + ", see below.");
  if (!results.missing.empty())
    html += bad(counted_text(results.missing.size(), "cell") + " not run.");
  if (!results.control_problems.empty()) {
    html += bad(html_text("Controls are off: " + join(results.control_problems, "; ") + "."));
  } else {
    html += record.controls_checked ? "All controls have their expected scores."
                                    : "The controls were not checked.";
  }
  return html + "</p>\n";
}

std::string methods_html(const RunResults& results) {
  TextTable table{"Each method over all sequences", "method"};
  // On a narrow screen, the main rate and the time are visible beside the name.
  const std::string first = results.protocols.empty() ? "" : results.protocols.front();
  const std::string main_rate = first.empty() ? "" : results.headline_of(first);
  std::vector<std::pair<std::string, std::string>> shown;  // Protocol and rate.
  if (!main_rate.empty()) {
    table.groups.push_back({first + ", mean", {main_rate}});
    shown.emplace_back(first, main_rate);
  }
  table.groups.push_back({"cost", {kTimeHeading, "peak MiB"}});
  const std::size_t costs = shown.size();
  for (const std::string& protocol : results.protocols) {
    TableGroup group{protocol + ", mean", {}};
    for (const std::string& rate : results.rates_of(protocol)) {
      if (protocol == first && rate == main_rate) continue;
      group.columns.push_back(rate);
      shown.emplace_back(protocol, rate);
    }
    if (!group.columns.empty()) table.groups.push_back(std::move(group));
  }
  for (const std::string& method : methods_best_first(results)) {
    TableRow row{method, {}, results.is_control(method)};
    for (const auto& [protocol, rate] : shown) {
      row.cells.push_back(mean_over_sequences(results, method, protocol, rate));
    }
    const auto cost = cost_cells(results, method, "n/a");
    row.cells.insert(row.cells.begin() + static_cast<std::ptrdiff_t>(costs), cost.begin(),
                     cost.end());
    table.rows.push_back(std::move(row));
  }
  std::vector<std::string> rates;
  for (const auto& [protocol, rate] : shown) rates.push_back(rate);
  for (std::size_t i = 0; i < shown.size() + 2; ++i) {
    const bool is_cost = i >= costs && i < costs + 2;
    const std::size_t rate = i < costs ? i : i - 2;
    mark_best(table, i, !is_cost && rate_spec(rates[rate]).higher_is_better);
  }
  std::string meanings;
  for (const std::string& protocol : results.protocols) {
    if (!results.rates_of(protocol).empty()) meanings += meaning_text(results, protocol) + " ";
  }
  if (!meanings.empty()) table.notes.push_back(meanings);
  table.notes.push_back(
      rate_units_text(rates) +
      " Bold: best, underlined: second; controls are listed below and not ranked. (4/5): the mean "
      "is over the 4 of 5 sequences that have a value. Click a heading to sort.");
  add_method_notes(results, table);
  return choice_html(results) + html_table(table);
}

std::string accuracy_html(const RunResults& results, const std::vector<OutsideColumn>& published) {
  std::string html;
  TableOptions options;
  options.outside = published;
  options.what = {"accuracy", "sweeps", "points", "confidence", "controls"};
  for (const TextTable& table : make_tables(results, options)) html += html_table(table);
  options.what = {"published"};
  for (const TextTable& table : make_tables(results, options)) {
    html += "<details><summary>Published results</summary>\n" + html_table(table) + "</details>\n";
  }
  std::string intervals;
  for (const TextTable& table : interval_tables(results)) {
    intervals += html_table(table, TableHeight::kScrolled);
  }
  if (!intervals.empty()) {
    html += "<details><summary>Intervals of the rates</summary>\n" + intervals + "</details>\n";
  }
  return html;
}

std::string losses_html(const RunResults& results) {
  std::string html;
  for (TextTable& table : loss_tables(results)) {
    add_method_notes(results, table);
    html += html_heat_table(table);
  }
  return html;
}

std::string cells_html(const RunResults& results) {
  TextTable table{"Every cell", "sequence", {{"", {"method", "status"}}}};
  for (const std::string& protocol : results.protocols) {
    const std::vector<std::string> rates = results.rates_of(protocol);
    if (!rates.empty()) table.groups.push_back({protocol, rates});
  }
  table.groups.push_back({"cost", {kTimeHeading, "peak MiB"}});
  for (const std::string& sequence : results.sequences) {
    for (const std::string& method : results.methods) {
      const Cell* cell = results.find(sequence, method);
      TableRow row{sequence, {{method}, {cell == nullptr ? "not run" : status_name(cell->status)}}};
      for (const std::string& protocol : results.protocols) {
        for (const std::string& rate : results.rates_of(protocol)) {
          const auto value = results.rate(sequence, method, protocol, rate);
          row.cells.push_back(value ? rate_cell({}, rate, *value) : TableCell{"n/a"});
        }
      }
      const Measurement* measured = cell != nullptr && cell->measured ? &*cell->measured : nullptr;
      row.cells.push_back(measured != nullptr ? number_cell(1000.0 * measured->mean_seconds, 1)
                                              : TableCell{"n/a"});
      row.cells.push_back(
          number_or(measured != nullptr ? measured->peak_memory_mib : std::nullopt, 0, "n/a"));
      table.rows.push_back(std::move(row));
    }
  }
  return html_table(table, TableHeight::kScrolled);
}

std::string confidence_html(const RunResults& results) {
  const Chart chart = reliability_chart(results);
  if (chart.empty()) return "";
  std::string html = "<div class=\"charts\">\n" + chart_html(chart) + "</div>\n";
  for (const TextTable& table : reliability_tables(results)) html += html_table(table);
  return html;
}

std::string sequences_html(const RunResults& results) {
  std::string html;
  for (const std::string& sequence : results.sequences) {
    std::string charts;
    for (const std::string& protocol : results.protocols) {
      charts += chart_html(interval_chart(results, protocol, sequence));
    }
    charts += chart_html(parts_chart(results, sequence));
    if (charts.empty()) continue;
    html += std::string(html.empty() ? "<details open>" : "<details>") + "<summary>" +
            html_name(sequence) + "</summary>\n<div class=\"charts\">\n" + charts +
            "</div></details>\n";
  }
  return html;
}

std::string charts_html(const RunResults& results) {
  std::string html = "<div class=\"charts\">\n";
  for (const std::string& protocol : results.protocols) {
    html += chart_html(pr_rr_chart(results, protocol));
  }
  for (const std::string& protocol : results.protocols) {
    html += chart_html(accuracy_time_chart(results, protocol));
  }
  for (const std::string& protocol : results.protocols) {
    html += chart_html(sweep_chart(results, protocol));
  }
  html += "</div>\n";
  std::string stages;
  for (const TextTable& table : make_tables(results, {.what = {"times", "stages"}})) {
    stages += html_table(table);
  }
  if (!stages.empty()) {
    html += "<details><summary>Time of each stage as tables</summary>\n" + stages + "</details>\n";
  }
  return html;
}

}  // namespace raymoval
