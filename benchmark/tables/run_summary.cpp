// SPDX-License-Identifier: MIT
#include "benchmark/tables/run_summary.h"

#include <algorithm>

#include "benchmark/tables/rate_grid.h"
#include "benchmark/tables/tables.h"
#include "benchmark/tables/text/text_table.h"
#include "core/text.h"
#include "core/utf8.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr std::size_t kMostName = 40;     ///< Characters of a method's name.
constexpr std::size_t kMostMethods = 20;  ///< Rows of a table.
constexpr std::size_t kMostFailures = 5;  ///< Cells that are named.
constexpr std::size_t kScreenLines = 40;

/// A rate of a protocol.
struct SummaryColumn {
  std::string protocol, rate;
};

TableCell summary_cell(const RunResults& results, const std::string& cell,
                       const SummaryColumn& column) {
  return mean_cell({}, column.rate, mean_of(results.values(cell, column.protocol, column.rate)),
                   results.sequences.size());
}

/// The methods, best first by the first protocol; the controls if there is nothing else.
std::vector<std::string> summary_methods(const RunResults& results) {
  std::vector<std::string> methods = methods_best_first(results);
  std::erase_if(methods, [&](const std::string& method) { return results.is_control(method); });
  return methods.empty() ? results.methods : methods;
}

/// The rates of the first protocol; of the others the main one if it has another name.
std::vector<SummaryColumn> summary_columns(const RunResults& results) {
  std::vector<SummaryColumn> columns;
  for (std::size_t i = 0; i < results.protocols.size(); ++i) {
    for (const std::string& rate : results.rates_of(results.protocols[i])) {
      const RateRole role = rate_spec(rate).role;
      const bool shown = i == 0 ? role != RateRole::kMean : role == RateRole::kHeadline;
      if (shown) columns.push_back({results.protocols[i], rate});
    }
  }
  return columns;
}

/// The first columns of a table that are no wider than a terminal.
std::string fitting_text(TextTable table) {
  const auto width_of = [](const std::string& text) {
    std::size_t width = 0;
    for (const std::string_view line : split(text, '\n')) {
      width = std::max(width, character_count(std::string(line)));
    }
    return width;
  };
  std::string text = to_plain(table);
  while (width_of(text) > kTerminalWidth && table.groups[0].columns.size() > 1) {
    table.groups[0].columns.pop_back();
    for (TableRow& row : table.rows) row.cells.pop_back();
    text = to_plain(table);
  }
  return text;
}

/// A row for each method: rates, time, memory.
TextTable method_summary(const RunResults& results, const std::vector<std::string>& methods) {
  const std::vector<SummaryColumn> columns = summary_columns(results);
  const bool several = results.protocols.size() > 1;
  TextTable table{"", "method", {{"", {}}}};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool other = several && columns[i].protocol != results.protocols.front();
    table.groups[0].columns.push_back((other ? columns[i].protocol + " " : "") + columns[i].rate);
  }
  const std::vector<std::string> shares = object_shares(results);
  table.groups[0].columns.insert(table.groups[0].columns.end(), shares.begin(), shares.end());
  table.groups[0].columns.insert(table.groups[0].columns.end(), {kTimeHeading, "peak MiB"});
  for (const std::string& method : methods) {
    TableRow row{shortened_middle(method, kMostName), {}};
    for (const SummaryColumn& column : columns) {
      row.cells.push_back(summary_cell(results, method, column));
    }
    for (const std::string& share : shares) {
      const MethodColumns* known = results.columns_of(method);
      row.cells.push_back(number_or(known ? known->find(share).percent() : std::nullopt, 1, "-"));
    }
    for (TableCell& cell : cost_cells(results, method, "-")) row.cells.push_back(cell);
    table.rows.push_back(std::move(row));
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    mark_best(table, i, rate_spec(columns[i].rate).higher_is_better);
  }
  for (std::size_t i = 0; i < shares.size(); ++i) mark_best(table, columns.size() + i, true);
  for (const std::size_t cost : {0U, 1U}) {
    mark_best(table, columns.size() + shares.size() + cost, false);
  }
  return table;
}

/// The main rate of the first protocol on each sequence.
TextTable sequence_summary(const RunResults& results, const std::vector<std::string>& methods) {
  const SummaryColumn main{results.protocols.front(),
                           results.headline_of(results.protocols.front())};
  TextTable table{"", main.rate, {{"", results.sequences}}};
  for (const std::string& method : methods) {
    TableRow& row = table.rows.emplace_back(TableRow{shortened_middle(method, kMostName), {}});
    for (const std::string& sequence : results.sequences) {
      const auto value = results.rate(sequence, method, main.protocol, main.rate);
      const Cell* cell = results.find(sequence, method);
      const char* lack = cell == nullptr ? "-" : cell->ok() ? "n/a" : status_name(cell->status);
      row.cells.push_back(value ? rate_cell({}, main.rate, *value) : TableCell{lack});
    }
  }
  for (std::size_t i = 0; i < results.sequences.size(); ++i) {
    mark_best(table, i, rate_spec(main.rate).higher_is_better);
  }
  return table;
}

std::string failures_text(const RunResults& results) {
  std::string text;
  std::size_t failures = 0;
  for (const Cell& cell : results.cells) {
    if (cell.ok() || ++failures > kMostFailures) continue;
    const std::string status = status_name(cell.status);
    text += shortened_end(status + ": " + cell.title() + ": " + cell.reason, kTerminalWidth) + "\n";
  }
  if (failures > kMostFailures) {
    text += "... and " + std::to_string(failures - kMostFailures) + " more cells failed\n";
  }
  if (!results.missing.empty()) {
    text += shortened_end("not run: " + join(results.missing), kTerminalWidth) + "\n";
  }
  return text.empty() ? "" : "\n" + text;
}

std::string title_of(const RunResults& results, std::size_t methods) {
  std::string text =
      results.name + ": " + counted_text(methods, "method") + " on " +
      (results.sequences.size() == 1
           ? results.sequences.front()
           : counted_text(results.sequences.size(), "sequence") + ", means over the sequences");
  if (!results.protocols.empty()) text += ", by protocol " + results.protocols.front();
  return text + "; * best";
}

}  // namespace

std::string run_summary(const RunResults& results, const std::string& place) {
  std::vector<std::string> methods = summary_methods(results);
  std::string text = wrapped(title_of(results, methods.size()), kTerminalWidth) + "\n";
  const std::size_t left_out = methods.size() - std::min(methods.size(), kMostMethods);
  methods.resize(methods.size() - left_out);
  text += fitting_text(method_summary(results, methods));
  if (left_out > 0) text += "... and " + std::to_string(left_out) + " more\n";
  const bool ranked =
      !results.protocols.empty() && !results.headline_of(results.protocols[0]).empty();
  if (ranked && results.sequences.size() > 1 && 2 * methods.size() + 12 <= kScreenLines) {
    const TextTable by_sequence = sequence_summary(results, methods);
    const std::string shown = fitting_text(by_sequence);
    // Half of the sequences would mislead: all or none.
    if (shown == to_plain(by_sequence)) text += "\n" + shown;
  }
  for (const ChangedMethod& changed : results.changed) {
    text += wrapped(changed.note(), kTerminalWidth);
  }
  text += failures_text(results);
  const bool controls = std::ranges::any_of(
      results.methods, [&](const std::string& method) { return results.is_control(method); });
  if (controls) text += "\n" + wrapped(controls_text(results), kTerminalWidth);
  return text + (controls ? "" : "\n") +
         wrapped("More: `raymoval table " + place + "`, `raymoval report " + place + "`.",
                 kTerminalWidth);
}

}  // namespace raymoval
