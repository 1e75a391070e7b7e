// SPDX-License-Identifier: MIT
#include "benchmark/tables/tables.h"

#include <algorithm>

#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

/// At most so much of a text that somebody else wrote, cut between characters.
std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 200;
  if (text.size() <= kMost) return text;
  return cut_text(text, kMost) + " ...";
}

/// The last line of `text` that holds anything, without what would steer a terminal.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  text.erase(0, text.rfind('\n') + 1);
  return printable_text(text);
}

/// What became of the cells that have no result.
TextTable failure_table(const RunResults& results) {
  TextTable table{
      "Cells without a result", "cell", {{"", {"status", "reason", "last line printed"}}}};
  for (const Cell& cell : results.cells) {
    if (cell.ok()) continue;
    const std::string last = shortened(last_line(cell.output_tail));
    table.rows.push_back(
        {cell.title(), {{status_name(cell.status)}, {shortened(cell.reason)}, {last}}});
  }
  for (const std::string& cell : results.missing) {
    table.rows.push_back({cell, {{"not run"}, {""}, {""}}});
  }
  return table;
}

std::string side_by_side_note(int cells) {
  return "Up to " + std::to_string(cells) +
         " cells ran at once (--jobs), each with one thread: each is slower than alone.";
}

/// Time and memory of every method, the least marked.
std::vector<TextTable> cost_tables(const RunResults& results) {
  TextTable table{"Time of each method", "method", {{"", {kTimeHeading, "peak MiB"}}}};
  for (const MethodTimes& times : results.times) {
    if (results.is_swept(times.cell)) continue;
    table.rows.push_back({times.cell, cost_cells(results, times.cell, "-")});
  }
  if (table.rows.size() < 2) return {};
  for (const std::size_t place : {0U, 1U}) mark_best(table, place, false);
  table.notes.push_back("Over all scans, without reading them; the most memory on any sequence.");
  int side_by_side = 1;
  for (const MethodTimes& times : results.times) {
    side_by_side = std::max(side_by_side, times.side_by_side);
  }
  if (side_by_side > 1) table.notes.push_back(side_by_side_note(side_by_side));
  return {table};
}

TextTable stage_table(const MethodTimes& times) {
  // Each thread books what it did: stages that run on several threads at once can add up to more
  // than the time that passed, of which they then have no shares.
  double named = 0.0;
  for (const auto& [name, seconds] : times.stages) named += seconds;
  const bool overlap = named > times.seconds;
  const double whole = overlap ? named : times.seconds;
  const double scans = static_cast<double>(std::max<std::size_t>(times.scans, 1));
  TextTable table{"Time of " + times.cell, "stage", {{"", {kTimeHeading, "share in %"}}}};
  const auto add = [&](const std::string& name, double seconds, bool summary) {
    const double share = whole > 0.0 ? 100.0 * seconds / whole : 0.0;
    table.rows.push_back(
        {name, {{fixed_text(1000.0 * seconds / scans, 3)}, {fixed_text(share, 1)}}, summary});
  };
  for (const auto& [name, seconds] : times.stages) add(name, seconds, false);
  if (named < times.seconds) add("other", times.seconds - named, false);
  add(overlap ? "sum over threads" : "total", whole, true);
  if (overlap) {
    table.rows.push_back(
        {"time that passed", {{fixed_text(1000.0 * times.seconds / scans, 3)}, {"-"}}, true});
  }
  table.notes.push_back("Mean over " + grouped_text(times.scans) +
                        " scans. Reading scans (load) took another " +
                        fixed_text(1000.0 * times.load_seconds / scans, 3) + " ms per scan.");
  if (times.threads > 1) {
    table.notes.push_back("With " + std::to_string(times.threads) +
                          " threads: a stage that runs on several at once is summed over them" +
                          (overlap ? ", and shares are of the sum of all stages." : "."));
  }
  if (times.side_by_side > 1) table.notes.push_back(side_by_side_note(times.side_by_side));
  if (times.repeats > 1) {
    table.notes.push_back("The median of " + std::to_string(times.repeats) + " runs.");
  }
  return table;
}

}  // namespace

std::vector<TextTable> make_tables(const RunResults& results, const TableOptions& options) {
  std::vector<TextTable> tables;
  const auto append = [&tables](std::vector<TextTable> more) {
    for (TextTable& table : more) tables.push_back(std::move(table));
  };
  for (const std::string& protocol : results.protocols) {
    append(accuracy_tables(results, protocol, options));
  }
  append(sweep_tables(results, options));
  append(published_tables(results, options));
  append(ranking_tables(results, options));
  append(compact_column_tables(results));
  append(reliability_tables(results));
  for (const std::string& protocol : results.protocols) {
    append(control_tables(results, protocol, options));
  }
  TextTable failures = failure_table(results);
  if (!failures.rows.empty()) tables.push_back(std::move(failures));
  append(cost_tables(results));
  for (const MethodTimes& times : results.times) {
    if (!results.is_swept(times.cell)) tables.push_back(stage_table(times));
  }
  return tables;
}

std::vector<TableCell> cost_cells(const RunResults& results, const std::string& method,
                                  const char* none) {
  return {number_or(results.ms_per_scan(method), 1, none),
          number_or(results.peak_mib(method), 0, none)};
}

std::string tables_markdown(const RunResults& results, const std::vector<TextTable>& tables) {
  std::string text = "# " + markdown_text(results.name) + "\n";
  for (const TextTable& table : tables) text += "\n" + to_markdown(table);
  return text;
}

std::string tables_latex(const std::vector<TextTable>& tables) {
  // LaTeX holds a limited number of tables that it has not found a place for.
  constexpr std::size_t kTablesAtOnce = 8;
  std::string text;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (i > 0) text += i % kTablesAtOnce == 0 ? "\n\\clearpage\n" : "\n";
    text += to_latex(tables[i]);
  }
  return text;
}

}  // namespace raymoval
