// SPDX-License-Identifier: MIT
// The parts of a report about methods and cells as a whole.
#include <algorithm>
#include <cmath>
#include <functional>

#include "benchmark/picture/charts/charts.h"
#include "benchmark/report/sections.h"
#include "benchmark/tables/accuracy_tables.h"
#include "benchmark/tables/column_tables.h"
#include "core/text.h"
#include "eval/rate.h"

namespace raymoval {
namespace {

/// "98.123", or "98.123 (4/5)" where sequences have no value.
std::string mean_over_sequences(const RunResults& results, const std::string& cell,
                                const std::string& protocol, const std::string& rate) {
  std::vector<std::optional<double>> values;
  for (const std::string& sequence : results.sequences) {
    const ResultRow* row = results.find(sequence, cell, protocol);
    const bool there = row != nullptr && row->rates.contains(rate);
    values.push_back(there ? row->rates.at(rate) : std::nullopt);
  }
  return mean_text({}, rate, values);
}

std::string time_text(const RunResults& results, const std::string& cell) {
  const auto ms = results.ms_per_scan(cell);
  return ms ? fixed_text(*ms, 1) : "n/a";
}

std::string memory_text(const RunResults& results, const std::string& cell) {
  const auto most = results.peak_mib(cell);
  return most ? fixed_text(*most, 0) : "n/a";
}

/// Marks best and second of a column over the rows that are no controls.
void mark_column(TextTable& table, std::size_t place, bool higher_is_better) {
  std::vector<TableCell*> cells;
  for (TableRow& row : table.rows) {
    if (!row.summary) cells.push_back(&row.cells[place]);
  }
  mark_best(cells, higher_is_better);
}

std::string fact(const std::string& name, const std::string& value, const std::string& more,
                 const char* look = "") {
  return "<div><dt>" + html_text(name) + "</dt><dd class=\"" + look + "\">" + html_name(value) +
         (more.empty() ? "" : "<small>" + html_text(more) + "</small>") + "</dd></div>\n";
}

std::string chart_html(const std::string& svg) {
  return svg.empty() ? "" : "<div class=\"chart\">" + svg + "</div>\n";
}

/// The method with the best mean of the first protocol's main rate.
std::pair<std::string, std::string> best_method(const RunResults& results) {
  std::pair<std::string, std::string> best;
  if (results.protocols.empty()) return best;
  const std::string& protocol = results.protocols.front();
  const std::string rate = results.headline_of(protocol);
  const double sign = rate_spec(rate).higher_is_better ? 1.0 : -1.0;
  std::optional<double> highest;
  for (const std::string& cell : results.cells) {
    if (rate.empty() || results.is_control(cell)) continue;
    const std::string text = mean_over_sequences(results, cell, protocol, rate);
    const auto value = leading_number(text);
    if (!value || (highest && sign * *value <= *highest)) continue;
    highest = sign * *value;
    best = {cell, "mean " + rate + " " + text + " by " + protocol};
  }
  return best;
}

}  // namespace

std::string facts_html(const ReportContent& content) {
  const RunResults& results = *content.results;
  std::string html = "<dl class=\"facts\">\n";
  const auto [best, why] = best_method(results);
  if (!best.empty()) html += fact("Most accurate", best, why);
  html += fact("Methods", std::to_string(results.cells.size()), "controls included");
  std::size_t scans = 0;
  for (const SequenceRecord& sequence : content.record->run.sequences) {
    scans += sequence.data.scans;
  }
  html +=
      fact("Sequences", std::to_string(results.sequences.size()), grouped_text(scans) + " scans");
  const std::size_t cells = content.record->cells.size();
  html += fact("Cells", std::to_string(cells),
               results.missing.empty() ? "" : std::to_string(results.missing.size()) + " not run");
  const std::size_t failed = results.failures.size();
  html += fact("Failed cells", std::to_string(failed), failed == 0 ? "" : "see below",
               failed == 0 ? "good" : "bad");
  const bool checked = content.record->controls_checked;
  const bool off = !results.control_problems.empty();
  html += fact("Controls",
               !checked ? "not checked"
               : off    ? "off"
                        : "as they must be",
               off ? join(results.control_problems, "; ") : "",
               off       ? "bad"
               : checked ? "good"
                         : "");
  return html + "</dl>\n";
}

std::string methods_html(const ReportContent& content) {
  const RunResults& results = *content.results;
  TextTable table{"Each method over all sequences", "method", {}, {}, {}};
  std::vector<std::function<std::string(const std::string&)>> texts;
  std::vector<int> better;  // 1: higher, -1: lower.
  for (const std::string& protocol : results.protocols) {
    const std::vector<std::string> rates = results.rates_of(protocol);
    if (rates.empty()) continue;
    table.groups.push_back({protocol + ", mean", rates});
    for (const std::string& rate : rates) {
      texts.emplace_back([&results, protocol, rate](const std::string& cell) {
        return mean_over_sequences(results, cell, protocol, rate);
      });
      better.push_back(rate_spec(rate).higher_is_better ? 1 : -1);
    }
  }
  table.groups.push_back({"cost", {"ms per scan", "peak MiB"}});
  texts.emplace_back([&](const std::string& cell) { return time_text(results, cell); });
  texts.emplace_back([&](const std::string& cell) { return memory_text(results, cell); });
  better.insert(better.end(), {-1, -1});
  for (const std::string& cell : results.cells) {
    TableRow row{cell, {}, results.is_control(cell)};
    for (const auto& text : texts) row.cells.push_back({text(cell)});
    table.rows.push_back(std::move(row));
  }
  for (std::size_t i = 0; i < better.size(); ++i) mark_column(table, i, better[i] > 0);
  table.notes.push_back(
      "Rates in percent, F1 as a fraction. Bold: best, underlined: second; controls stand below "
      "and "
      "are not ranked. (4/5): the mean is over the 4 of 5 sequences that have a value. Click a "
      "heading to sort.");
  return html_table(table);
}

std::string accuracy_html(const ReportContent& content) {
  std::string html;
  TableOptions options;
  options.outside = content.published;
  for (const TextTable& table : make_tables(*content.results, options)) {
    const bool elsewhere =
        table.title.starts_with("Time of ") || table.title == "Cells without a result";
    if (elsewhere) continue;
    if (table.title.starts_with("Published")) {
      html +=
          "<details><summary>What papers print</summary>\n" + html_table(table) + "</details>\n";
    } else {
      html += html_table(table);
    }
  }
  std::string intervals;
  for (const TextTable& table : full_column_tables(*content.results)) {
    if (table.title.starts_with("Intervals")) {
      intervals += html_table(table, TableHeight::kScrolled);
    }
  }
  if (!intervals.empty()) {
    html += "<details><summary>Intervals of the rates</summary>\n" + intervals + "</details>\n";
  }
  return html;
}

std::string cells_html(const ReportContent& content) {
  const RunResults& results = *content.results;
  TextTable table{"Every cell", "sequence", {{"", {"method", "status"}}}, {}, {}};
  for (const std::string& protocol : results.protocols) {
    const std::vector<std::string> rates = results.rates_of(protocol);
    if (!rates.empty()) table.groups.push_back({protocol, rates});
  }
  table.groups.push_back({"cost", {"ms per scan", "peak MiB"}});
  for (const std::string& sequence : results.sequences) {
    for (const std::string& cell : results.cells) {
      TableRow row{sequence, {{cell}, {"not run"}}, false};
      const ResultRow* any = nullptr;
      for (const std::string& protocol : results.protocols) {
        const ResultRow* scored = results.find(sequence, cell, protocol);
        if (scored != nullptr) any = scored;
        for (const std::string& rate : results.rates_of(protocol)) {
          const bool there = scored != nullptr && scored->rates.contains(rate) &&
                             scored->rates.at(rate).has_value();
          row.cells.push_back({there ? rate_text(rate, *scored->rates.at(rate)) : "n/a"});
        }
      }
      if (any != nullptr) row.cells[1].text = any->status;
      const auto text = [](const std::optional<double>& value, double factor, int digits) {
        return value ? fixed_text(*value * factor, digits) : "n/a";
      };
      row.cells.push_back({any == nullptr ? "n/a" : text(any->seconds_per_scan, 1000.0, 1)});
      row.cells.push_back({any == nullptr ? "n/a" : text(any->peak_memory_mib, 1.0, 0)});
      table.rows.push_back(std::move(row));
    }
  }
  return html_table(table, TableHeight::kScrolled);
}

std::string charts_html(const ReportContent& content) {
  const RunResults& results = *content.results;
  std::string html = "<div class=\"charts\">\n";
  for (const std::string& protocol : results.protocols) {
    html += chart_html(pr_rr_chart(results, protocol, ChartPlace::kPage));
  }
  for (const std::string& protocol : results.protocols) {
    html += chart_html(accuracy_time_chart(results, protocol, ChartPlace::kPage));
  }
  html += chart_html(stage_chart(results, ChartPlace::kPage)) + "</div>\n";
  std::string stages;
  for (const TextTable& table : make_tables(results)) {
    if (table.title.starts_with("Time of ")) stages += html_table(table);
  }
  if (!stages.empty()) {
    html += "<details><summary>Time of each stage as tables</summary>\n" + stages + "</details>\n";
  }
  return html;
}

}  // namespace raymoval
