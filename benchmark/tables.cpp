// SPDX-License-Identifier: MIT
#include "benchmark/tables.h"

#include <algorithm>
#include <optional>
#include <set>

#include "benchmark/column_tables.h"
#include "benchmark/sweep_tables.h"
#include "core/text.h"
#include "eval/averages.h"

namespace raymoval {
namespace {

constexpr const char* kErasor = "erasor";
constexpr const char* kDynamicmap = "dynamicmap";

/// A method's rates by sequence, from the run or from elsewhere.
struct Column {
  std::string heading;
  std::vector<const RateValues*> by_sequence;  ///< Null: not known there.
  std::vector<std::string> status;             ///< Shown where there are no rates.
  int published_digits = 0;  ///< Decimals that were printed; 0: a column of the run.
};

const std::vector<std::string>& shown_rates() {
  static const std::vector<std::string> rates = {"PR", "RR", "F1", "SA", "DA", "AA", "HA"};
  return rates;
}

std::vector<std::string> rates_of(const RunResults& results, const std::string& protocol) {
  std::vector<std::string> rates;
  for (const std::string& rate : shown_rates()) {
    const bool there = std::any_of(results.rows.begin(), results.rows.end(), [&](const auto& row) {
      return row.protocol == protocol && row.rates.count(rate) > 0;
    });
    if (there) rates.push_back(rate);
  }
  return rates;
}

std::vector<Column> run_columns(const RunResults& results, const std::string& protocol,
                                bool controls) {
  std::vector<Column> columns;
  for (const std::string& cell : results.cells) {
    if (results.is_swept(cell)) continue;  // Shown in a table of its own.
    Column column{cell, {}, {}};
    bool wanted = false;
    for (const std::string& sequence : results.sequences) {
      const ResultRow* row = results.find(sequence, cell, protocol);
      const bool scored = row != nullptr && row->status == "ok";
      column.by_sequence.push_back(scored ? &row->rates : nullptr);
      column.status.push_back(row != nullptr ? row->status : "");
      if (row != nullptr && row->control == controls) wanted = true;
    }
    if (wanted) columns.push_back(std::move(column));
  }
  return columns;
}

Column outside_column(const std::vector<std::string>& sequences, const OutsideColumn& given) {
  Column column{given.heading, {}, {}, given.protocol == kErasor ? 3 : 2};
  for (const std::string& sequence : sequences) {
    column.by_sequence.push_back(given.find(sequence));
    column.status.push_back("-");
  }
  return column;
}

bool has(const std::vector<std::string>& rates, const std::string& rate) {
  return std::find(rates.begin(), rates.end(), rate) != rates.end();
}

/// Whether published numbers are of the protocol that a run calls `protocol`. The strict variant of
/// dynamicmap has the same rates by other rules.
bool is_of(const OutsideColumn& given, const std::string& protocol,
           const std::vector<std::string>& rates) {
  if (given.protocol == kErasor) return has(rates, "PR") && has(rates, "RR");
  return given.protocol == protocol;
}

void add_outside(const RunResults& results, const std::string& protocol,
                 const std::vector<std::string>& rates, const std::vector<OutsideColumn>& outside,
                 std::vector<Column>& columns) {
  for (const OutsideColumn& given : outside) {
    if (!is_of(given, protocol, rates)) continue;
    Column column = outside_column(results.sequences, given);
    const bool shared = std::any_of(column.by_sequence.begin(), column.by_sequence.end(),
                                    [](const RateValues* known) { return known != nullptr; });
    if (shared) columns.push_back(std::move(column));
  }
}

std::string column_text(const Column& column, const std::string& rate, double value) {
  return column.published_digits > 0 ? fixed_text(value, column.published_digits)
                                     : rate_text(rate, value);
}

std::optional<double> rate_at(const Column& column, std::size_t sequence, const std::string& rate) {
  if (column.by_sequence[sequence] == nullptr) return std::nullopt;
  const auto found = column.by_sequence[sequence]->find(rate);
  return found == column.by_sequence[sequence]->end() ? std::nullopt : found->second;
}

/// The values of `rate` over the sequences.
std::vector<std::optional<double>> values_of(const Column& column, const std::string& rate) {
  std::vector<std::optional<double>> values;
  for (std::size_t i = 0; i < column.by_sequence.size(); ++i) {
    values.push_back(rate_at(column, i, rate));
  }
  return values;
}

/// Marks the largest and second largest of the values at `place` of each group, as displayed: what
/// looks equal is marked alike.
void mark_best(TableRow& row, std::size_t place, std::size_t group_size) {
  std::set<double, std::greater<>> values;
  const auto value_of = [](const TableCell& cell) {
    return parse_number<double>(std::string_view(cell.text).substr(0, cell.text.find(' ')));
  };
  for (std::size_t i = place; i < row.cells.size(); i += group_size) {
    if (const auto value = value_of(row.cells[i])) values.insert(*value);
  }
  if (row.cells.size() / group_size < 2 || values.empty()) return;
  for (std::size_t i = place; i < row.cells.size(); i += group_size) {
    const auto value = value_of(row.cells[i]);
    if (!value) continue;
    if (*value == *values.begin()) row.cells[i].mark = Mark::kBest;
    if (values.size() > 1 && *value == *std::next(values.begin())) {
      row.cells[i].mark = Mark::kSecond;
    }
  }
}

TableRow sequence_row(const std::string& sequence, std::size_t index,
                      const std::vector<Column>& columns, const std::vector<std::string>& rates) {
  TableRow row{sequence, {}, false};
  for (const Column& column : columns) {
    for (const std::string& rate : rates) {
      const auto value = rate_at(column, index, rate);
      const std::string& status = column.status[index];
      const std::string missing = status.empty() || status == "ok" ? "n/a" : status;
      row.cells.push_back({value ? column_text(column, rate, *value) : missing});
    }
  }
  return row;
}

/// "98.123", or "98.123 (4/5)" where sequences without a value are left out.
std::string mean_text(const Column& column, const std::string& rate, const Mean& mean) {
  if (!mean.value) return "n/a";
  const std::string text = column_text(column, rate, *mean.value);
  const std::size_t of = column.by_sequence.size();
  if (mean.segments == of) return text;
  return text + " (" + std::to_string(mean.segments) + "/" + std::to_string(of) + ")";
}

TableRow mean_row(const std::vector<Column>& columns, const std::vector<std::string>& rates) {
  std::vector<std::string> names;
  for (const std::string& rate : rates) names.push_back("mean_" + rate);
  TableRow row{join(names), {}, true};
  for (const Column& column : columns) {
    for (const std::string& rate : rates) {
      const Mean mean = mean_of(values_of(column, rate));
      row.cells.push_back({mean_text(column, rate, mean)});
    }
  }
  return row;
}

TableRow f1_of_means_row(const std::vector<Column>& columns,
                         const std::vector<std::string>& rates) {
  TableRow row{"F1_of_means", {}, true};
  for (const Column& column : columns) {
    std::vector<SegmentRates> segments;
    for (std::size_t i = 0; i < column.by_sequence.size(); ++i) {
      segments.push_back(
          {rate_at(column, i, "PR"), rate_at(column, i, "RR"), rate_at(column, i, "F1")});
    }
    const AverageRates averages = average_rates(segments);
    for (const std::string& rate : rates) {
      row.cells.push_back({rate == "F1" ? mean_text(column, "F1", averages.F1_of_means) : ""});
    }
  }
  return row;
}

TextTable rate_table(const std::vector<std::string>& sequences, const std::string& title,
                     const std::vector<Column>& columns, const std::vector<std::string>& rates,
                     bool ranked) {
  TextTable table{title, "sequence", {}, {}, {}};
  for (const Column& column : columns) table.groups.push_back({column.heading, rates});
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    table.rows.push_back(sequence_row(sequences[i], i, columns, rates));
  }
  if (ranked) {
    table.rows.push_back(mean_row(columns, rates));
    if (has(rates, "F1")) table.rows.push_back(f1_of_means_row(columns, rates));
    for (TableRow& row : table.rows) {
      for (std::size_t place = 0; place < rates.size(); ++place) {
        mark_best(row, place, rates.size());
      }
    }
  }
  return table;
}

/// What the rates of a table are.
std::string rate_words(const std::vector<std::string>& rates) {
  if (has(rates, "F1")) {
    return "Rates in percent, F1 as a fraction. mean_F1 is the mean of the F1 values; F1_of_means "
           "is the F1 of mean PR and mean RR.";
  }
  return "Rates in percent; AA is the geometric and HA the harmonic mean of SA and DA.";
}

TextTable method_table(const RunResults& results, const std::string& protocol,
                       const std::vector<OutsideColumn>& outside) {
  const std::vector<std::string> rates = rates_of(results, protocol);
  std::vector<Column> columns = run_columns(results, protocol, false);
  add_outside(results, protocol, rates, outside, columns);
  TextTable table =
      rate_table(results.sequences, "Accuracy by protocol " + protocol, columns, rates, true);
  table.notes.push_back(rate_words(rates) +
                        " n/a: undefined or not run; (4/5): the mean is over the 4 of 5 sequences "
                        "that have a value.");
  return table;
}

TextTable control_table(const RunResults& results, const std::string& protocol) {
  const std::vector<std::string> rates = rates_of(results, protocol);
  TextTable table = rate_table(results.sequences, "Controls by protocol " + protocol,
                               run_columns(results, protocol, true), rates, false);
  table.notes.push_back(results.control_problems.empty()
                            ? "All controls are as they must be."
                            : "CONTROLS ARE OFF: " + join(results.control_problems, "; ") + ".");
  return table;
}

/// All published numbers of a protocol. Those of dynamicmap are on different kinds of data, over
/// which no mean is taken.
TextTable published_table(const std::vector<OutsideColumn>& outside, const std::string& protocol) {
  std::vector<std::string> sequences;
  std::vector<OutsideColumn> wanted;
  for (const OutsideColumn& given : outside) {
    if (given.protocol != protocol) continue;
    wanted.push_back(given);
    for (const auto& [name, rates] : given.sequences) {
      if (!has(sequences, name)) sequences.push_back(name);
    }
  }
  std::vector<Column> columns;
  for (const OutsideColumn& given : wanted) columns.push_back(outside_column(sequences, given));
  const bool erasor = protocol == kErasor;
  TextTable table = erasor ? rate_table(sequences, "Published", columns, {"PR", "RR", "F1"}, true)
                           : rate_table(sequences, "Published, DynamicMap benchmark", columns,
                                        {"SA", "DA", "AA", "HA"}, false);
  table.notes.push_back(
      erasor ? "Values as printed (Raymoval paper, Table 2); the means are computed from them, "
               "since two of the printed means are misprints."
             : "As printed by the benchmark, DUFOMap and BeautyMap, to 2 decimals; -: not printed. "
               "KITTI at every frame, without a range limit; which frames lie behind 01 is not "
               "known. More in results/published/.");
  return table;
}

/// The published tables of the protocols that the run was scored by.
std::vector<TextTable> published_tables(const RunResults& results,
                                        const std::vector<OutsideColumn>& outside) {
  std::vector<TextTable> tables;
  for (const char* published : {kErasor, kDynamicmap}) {
    const bool wanted = std::any_of(outside.begin(), outside.end(), [&](const auto& given) {
      return given.protocol == published &&
             std::any_of(results.protocols.begin(), results.protocols.end(),
                         [&](const std::string& protocol) {
                           return is_of(given, protocol, rates_of(results, protocol));
                         });
    });
    if (wanted) tables.push_back(published_table(outside, published));
  }
  return tables;
}

/// At most so much of a text that somebody else wrote, cut between characters.
std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 200;
  if (text.size() <= kMost) return text;
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + " ...";
}

/// What became of the cells that have no result.
TextTable failure_table(const RunResults& results) {
  TextTable table{
      "Cells without a result", "cell", {{"", {"status", "reason", "last line printed"}}}, {}, {}};
  for (const FailedCell& failed : results.failures) {
    table.rows.push_back(
        {failed.sequence + " / " + failed.cell,
         {{failed.status}, {shortened(failed.reason)}, {shortened(failed.last_output)}},
         false});
  }
  for (const std::string& cell : results.missing) {
    table.rows.push_back({cell, {{"not run"}, {""}, {""}}, false});
  }
  return table;
}

TextTable stage_table(const MethodTimes& times) {
  TextTable table{"Time of " + times.cell, "stage", {{"", {"ms per scan", "share in %"}}}, {}, {}};
  const double scans = static_cast<double>(std::max<std::size_t>(times.scans, 1));
  double named = 0.0;
  const auto add = [&](const std::string& name, double seconds, bool summary) {
    const double share = times.seconds > 0.0 ? 100.0 * seconds / times.seconds : 0.0;
    table.rows.push_back(
        {name, {{fixed_text(1000.0 * seconds / scans, 3)}, {fixed_text(share, 1)}}, summary});
  };
  for (const auto& [name, seconds] : times.stages) {
    add(name, seconds, false);
    named += seconds;
  }
  if (named < times.seconds) add("other", times.seconds - named, false);
  add("total", times.seconds, true);
  table.notes.push_back("Mean over " + grouped_text(times.scans) +
                        " scans. Reading scans (load) took another " +
                        fixed_text(1000.0 * times.load_seconds / scans, 3) + " ms per scan.");
  if (times.repeats > 1) {
    table.notes.push_back("The median of " + std::to_string(times.repeats) + " runs.");
  }
  return table;
}

}  // namespace

const RateValues* OutsideColumn::find(const std::string& name) const {
  const std::string prefix = protocol == kErasor ? "kitti-" : "kth-";
  for (const auto& [sequence, values] : sequences) {
    if (sequence == name || prefix + sequence == name) return &values;
  }
  return nullptr;
}

std::vector<TextTable> make_tables(const RunResults& results,
                                   const std::vector<OutsideColumn>& outside) {
  std::vector<TextTable> tables;
  for (const std::string& protocol : results.protocols) {
    TextTable methods = method_table(results, protocol, outside);
    if (!methods.groups.empty()) tables.push_back(std::move(methods));
  }
  for (TextTable& sweep : sweep_tables(results)) tables.push_back(std::move(sweep));
  const auto append = [&tables](std::vector<TextTable> more) {
    for (TextTable& table : more) tables.push_back(std::move(table));
  };
  append(published_tables(results, outside));
  append(ranking_tables(results));
  append(compact_column_tables(results));
  for (const std::string& protocol : results.protocols) {
    TextTable controls = control_table(results, protocol);
    if (!controls.groups.empty()) tables.push_back(std::move(controls));
  }
  if (!results.failures.empty() || !results.missing.empty()) {
    tables.push_back(failure_table(results));
  }
  for (const MethodTimes& times : results.times) {
    if (!results.is_swept(times.cell)) tables.push_back(stage_table(times));
  }
  return tables;
}

std::string tables_markdown(const RunResults& results, const std::vector<TextTable>& tables) {
  std::string text = "# " + results.name + "\n";
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
