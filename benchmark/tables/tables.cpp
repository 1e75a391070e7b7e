// SPDX-License-Identifier: MIT
#include "benchmark/tables/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

/// The beginning of a foreign text, cut between characters.
std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 200;
  if (text.size() <= kMost) return text;
  return cut_text(text, kMost) + " ...";
}

/// The last line of `text` that is not empty, without control sequences of terminals.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  text.erase(0, text.rfind('\n') + 1);
  return printable_text(text);
}

/// The tables of cells without a result; none if all have one.
std::vector<TextTable> failure_tables(const RunResults& results) {
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
  return table.rows.empty() ? std::vector<TextTable>() : std::vector{table};
}

std::string side_by_side_note(int cells) {
  return "Up to " + std::to_string(cells) +
         " cells ran in parallel, each with one thread: each is slower than alone.";
}

/// Time and memory of every method, with the least values marked.
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
  // Stage times are summed over threads. Their sum can exceed the elapsed time; shares are then
  // shares of the sum.
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
        {"wall time", {{fixed_text(1000.0 * times.seconds / scans, 3)}, {"-"}}, true});
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
  return table;
}

std::vector<TextTable> stage_tables(const RunResults& results) {
  std::vector<TextTable> tables;
  for (const MethodTimes& times : results.times) {
    if (!results.is_swept(times.cell)) tables.push_back(stage_table(times));
  }
  return tables;
}

using MakeTables = std::vector<TextTable>(const RunResults&, const TableOptions&);

/// The kinds of tables, in the order in which they are shown.
const std::vector<std::pair<std::string, std::function<MakeTables>>>& kinds_of_tables() {
  const auto by_protocol = [](auto& make) -> std::function<MakeTables> {
    return [&make](const RunResults& results, const TableOptions& options) {
      std::vector<TextTable> tables;
      for (const std::string& protocol : results.protocols) {
        for (TextTable& table : make(results, protocol, options)) tables.push_back(table);
      }
      return tables;
    };
  };
  const auto without_options = [](auto& make) -> std::function<MakeTables> {
    return [&make](const RunResults& results, const TableOptions&) { return make(results); };
  };
  static const std::vector<std::pair<std::string, std::function<MakeTables>>> kinds = {
      {"accuracy", by_protocol(accuracy_tables)},
      {"sweeps", sweep_tables},
      {"published", published_tables},
      {"points", without_options(compact_column_tables)},
      {"columns", without_options(column_tables)},
      {"losses", without_options(loss_tables)},
      {"intervals", without_options(interval_tables)},
      {"confidence", without_options(reliability_tables)},
      {"controls", by_protocol(control_tables)},
      {"failures", without_options(failure_tables)},
      {"times", without_options(cost_tables)},
      {"stages", without_options(stage_tables)}};
  return kinds;
}

/// Tables of other kinds are long, and are only made on request.
std::vector<std::string> kinds_shown_by_default() {
  std::vector<std::string> names = table_kinds();
  std::erase_if(names, [](const std::string& name) {
    return name == "columns" || name == "losses" || name == "intervals";
  });
  return names;
}

/// "0 to 60 m", or "any range".
std::string range_words(const RangeLimits& range) {
  if (range.max < RangeLimits{}.max) {
    return fmt::format("{} to {} m", number_text(range.min), number_text(range.max));
  }
  return range.min > 0.0 ? number_text(range.min) + " m and more" : "any range";
}

/// "05 (frames 2350 to 2670, stride 2, 161 scans, any range)" for each sequence.
std::string data_words(const RunResults& results) {
  std::vector<std::string> sequences;
  for (const std::string& sequence : results.sequences) {
    const DataRecord* data = results.data_of(sequence);
    if (data == nullptr) continue;
    const std::vector<std::string_view> parts = split(data->frames, ':');
    std::string frames;
    if (parts.size() == 3) {
      frames = fmt::format("frames {} to {}, stride {}, ", parts[0], parts[1], parts[2]);
    }
    sequences.push_back(fmt::format("{} ({}{}, {})", sequence, frames,
                                    counted_text(data->scans, "scan"), range_words(data->range_m)));
  }
  return sequences.empty() ? "" : "On " + join(sequences) + ".";
}

/// Whether the table has rows or columns of this method, or is about it.
bool shows(const TextTable& table, const std::string& method) {
  return std::ranges::any_of(table.rows, [&](const auto& row) { return row.label == method; }) ||
         std::ranges::any_of(table.groups,
                             [&](const TableGroup& group) {
                               return group.heading == method || is_among(group.columns, method);
                             }) ||
         (table.title + " ").find(" " + method + " ") != std::string::npos;
}

}  // namespace

std::vector<std::string> table_kinds() {
  std::vector<std::string> names;
  for (const auto& [name, make] : kinds_of_tables()) names.push_back(name);
  return names;
}

std::vector<std::string> latex_kinds(const RunResults& results) {
  const bool only_swept = std::ranges::all_of(results.methods, [&](const std::string& method) {
    return results.is_swept(method) || results.is_control(method);
  });
  return {only_swept && !results.sweeps.empty() ? "sweeps" : "accuracy"};
}

void add_method_notes(const RunResults& results, TextTable& table) {
  for (const ChangedMethod& changed : results.changed) {
    if (shows(table, changed.name)) table.notes.push_back(changed.note());
  }
  for (const auto& [data, methods] : results.developed_on) {
    std::vector<std::string> shown;
    std::ranges::copy_if(methods, std::back_inserter(shown),
                         [&](const std::string& method) { return shows(table, method); });
    if (!shown.empty()) table.notes.push_back("Developed on " + data + ": " + join(shown) + ".");
  }
}

std::vector<TextTable> make_tables(const RunResults& results, const TableOptions& options) {
  std::vector<TextTable> tables;
  const std::string data = data_words(results);
  for (const auto& [kind, make] : kinds_of_tables()) {
    if (!is_among(options.what.empty() ? kinds_shown_by_default() : options.what, kind)) continue;
    for (TextTable& table : make(results, options)) {
      if (kind != "published") table.data = data;
      add_method_notes(results, table);
      tables.push_back(std::move(table));
    }
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
  // LaTeX can hold only a limited number of unplaced floats.
  constexpr std::size_t kTablesAtOnce = 8;
  std::string text;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (i > 0) text += i % kTablesAtOnce == 0 ? "\n\\clearpage\n" : "\n";
    text += to_latex(tables[i]);
  }
  return text;
}

}  // namespace raymoval
