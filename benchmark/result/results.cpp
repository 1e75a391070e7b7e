// SPDX-License-Identifier: MIT
#include "benchmark/result/results.h"

#include <algorithm>

#include "benchmark/result/cell_json.h"
#include "benchmark/suite/cell_selection.h"
#include "core/text.h"
#include "core/utf8.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

ResultRow row_head(const Cell& cell) {
  ResultRow row;
  row.sequence = cell.sequence;
  row.cell = cell.name;
  row.method = cell.method.name;
  row.variant = cell.method.variant;
  row.control = cell.method.control;
  row.status = status_name(cell.status);
  if (cell.masks) row.mask_digest = cell.masks->digest;
  if (cell.measured) {
    row.seconds_per_scan = cell.measured->mean_seconds;
    row.peak_memory_mib = cell.measured->peak_memory_mib;
  }
  return row;
}

/// One row for each protocol of the suite, also where the cell failed.
void add_rows(const Cell& cell, RunResults& results) {
  for (const std::string& protocol : results.protocols) {
    ResultRow row = row_head(cell);
    row.protocol = protocol;
    for (const Score& score : cell.scores) {
      if (score.protocol.name != protocol) continue;
      for (const Rate& rate : score.rates) row.rates[rate.name] = rate.value;
      if (!score.intervals) continue;
      for (const Interval& interval : score.intervals->rates) {
        if (interval.low) row.intervals[interval.name] = {*interval.low, *interval.high};
      }
    }
    results.rows.push_back(std::move(row));
  }
}

/// The item of a list that is about a cell; it is added if there is none.
template <class Item>
Item& item_of(std::vector<Item>& list, const std::string& cell) {
  for (Item& known : list) {
    if (known.cell == cell) return known;
  }
  list.push_back({});
  list.back().cell = cell;
  return list.back();
}

void add_columns(const Cell& cell, RunResults& results) {
  if (!cell.ok() || !cell.columns) return;
  MethodColumns& method = item_of(results.columns, cell.name);
  method.control = cell.method.control;
  ++method.sequences;
  for (const ColumnValue& column : cell.columns->values) {
    auto found = std::find_if(method.values.begin(), method.values.end(),
                              [&](const auto& known) { return known.first == column.name; });
    if (found == method.values.end()) found = method.values.insert(found, {column.name, Share{}});
    found->second.part += column.share.part;
    found->second.whole += column.share.whole;
  }
}

void add_reliability(const Cell& cell, RunResults& results) {
  if (!cell.ok() || !cell.reliability) return;
  MethodReliability& method = item_of(results.reliability, cell.name);
  ++method.sequences;
  method.all += *cell.reliability;
}

void add_stage(MethodTimes& times, const std::string& name, double seconds) {
  for (auto& [known, sum] : times.stages) {
    if (known == name) {
      sum += seconds;
      return;
    }
  }
  times.stages.emplace_back(name, seconds);
}

void add_times(const Cell& cell, RunResults& results) {
  if (!cell.ok() || !cell.measured || !cell.data || cell.method.control) return;
  MethodTimes& times = item_of(results.times, cell.name);
  times.scans += cell.data->scans;
  times.seconds += cell.measured->total_seconds;
  times.load_seconds += cell.measured->load_seconds;
  times.threads = std::max(times.threads, cell.measured->threads);
  times.side_by_side = std::max(times.side_by_side, cell.measured->side_by_side.value_or(1));
  if (!cell.measured->repeats.empty()) {
    times.repeats = static_cast<int>(cell.measured->repeats.size());
  }
  for (const StageSeconds& stage : cell.measured->stages) {
    add_stage(times, stage.name, stage.seconds);
  }
}

/// The last line of `text` that holds anything, without what would steer a terminal.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  text.erase(0, text.rfind('\n') + 1);
  return printable_text(text);
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace

std::optional<double> ResultRow::rate(const std::string& name) const {
  const auto found = rates.find(name);
  return status != "ok" || found == rates.end() ? std::nullopt : found->second;
}

const std::string& RunResults::kind_of(const std::string& protocol) const {
  const auto found = protocol_kinds.find(protocol);
  return found == protocol_kinds.end() ? protocol : found->second;
}

SegmentValues RunResults::values(const std::string& cell, const std::string& protocol,
                                 const std::string& rate) const {
  SegmentValues list;
  for (const std::string& sequence : sequences) {
    const ResultRow* row = find(sequence, cell, protocol);
    list.push_back(row == nullptr ? std::nullopt : row->rate(rate));
  }
  return list;
}

const ResultRow* RunResults::find(const std::string& sequence, const std::string& cell,
                                  const std::string& protocol) const {
  for (const ResultRow& row : rows) {
    if (row.sequence == sequence && row.cell == cell && row.protocol == protocol) return &row;
  }
  return nullptr;
}

const SweptCell* RunResults::swept(const std::string& cell) const {
  for (const SweptCell& point : sweeps) {
    if (point.cell == cell) return &point;
  }
  return nullptr;
}

bool RunResults::is_control(const std::string& cell) const {
  return std::any_of(rows.begin(), rows.end(),
                     [&](const ResultRow& row) { return row.cell == cell && row.control; });
}

std::optional<double> RunResults::ms_per_scan(const std::string& cell) const {
  for (const MethodTimes& known : times) {
    if (known.cell != cell || known.scans == 0) continue;
    return 1000.0 * known.seconds / static_cast<double>(known.scans);
  }
  return std::nullopt;
}

std::optional<double> RunResults::peak_mib(const std::string& cell) const {
  std::optional<double> most;
  for (const ResultRow& row : rows) {
    if (row.cell != cell || !row.peak_memory_mib) continue;
    most = std::max(most.value_or(0.0), *row.peak_memory_mib);
  }
  return most;
}

std::vector<std::string> RunResults::rates_of(const std::string& protocol) const {
  std::vector<std::string> rates;
  for (const RateSpec& spec : rate_specs()) {
    if (spec.role == RateRole::kSecondary) continue;
    const bool there = std::any_of(rows.begin(), rows.end(), [&](const ResultRow& row) {
      return row.protocol == protocol && row.rates.contains(spec.name);
    });
    if (there) rates.push_back(spec.name);
  }
  return rates;
}

std::string RunResults::headline_of(const std::string& protocol) const {
  for (const std::string& rate : rates_of(protocol)) {
    if (rate_spec(rate).role == RateRole::kHeadline) return rate;
  }
  return "";
}

std::string SweptCell::sweep() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : values) keys.push_back(key);
  return of + " over " + join(keys);
}

std::string SweptCell::point() const {
  std::vector<std::string> pairs;
  for (const auto& [key, value] : values) pairs.push_back(key + "=" + value);
  return join(pairs);
}

Share MethodColumns::find(const std::string& name) const {
  for (const auto& [column, share] : values) {
    if (column == name) return share;
  }
  return {};
}

RunResults shown_results(const ResultsRecord& results) {
  RunResults shown;
  shown.name = results.run.suite;
  shown.sequences = names_of(results.run.sequences);
  shown.cells = names_of(results.run.methods);
  shown.protocols = names_of(results.run.protocols);
  for (const ProtocolRecord& protocol : results.run.protocols) {
    shown.protocol_kinds[protocol.name] = protocol.protocol;
  }
  for (const SuiteMethodRecord& method : results.run.methods) {
    if (!method.sweep) continue;
    SweptCell swept{method.name, method.sweep->of, {}};
    for (const auto& [key, value] : method.sweep->values) {
      const auto* text = std::get_if<std::string>(&value);
      swept.values.emplace_back(key, text != nullptr ? *text : value_text(value));
    }
    shown.sweeps.push_back(std::move(swept));
  }
  for (const Cell& cell : results.cells) {
    add_rows(cell, shown);
    add_columns(cell, shown);
    add_reliability(cell, shown);
    add_times(cell, shown);
    if (cell.ok()) continue;
    shown.failures.push_back({cell.sequence, cell.name, status_name(cell.status), cell.reason,
                              last_line(cell.output_tail)});
  }
  shown.missing = results.missing;
  shown.control_problems = results.control_problems;
  return shown;
}

std::string results_csv(const RunResults& results) {
  std::vector<std::string> rates;
  for (const RateSpec& spec : rate_specs()) {
    if (spec.role != RateRole::kSecondary) rates.push_back(spec.name);
  }
  std::string csv = "sequence,method,variant,protocol,status," + join(rates, ",") +
                    ",seconds_per_scan,peak_memory_mib,name\n";
  for (const ResultRow& row : results.rows) {
    csv += csv_text(row.sequence) + "," + csv_text(row.method) + "," + csv_text(row.variant) + "," +
           csv_text(row.protocol) + "," + csv_text(row.status);
    for (const std::string& rate : rates) {
      const auto found = row.rates.find(rate);
      csv += ",";
      if (found != row.rates.end() && found->second) csv += rate_text(rate, *found->second);
    }
    csv += "," + (row.seconds_per_scan ? fixed_text(*row.seconds_per_scan, 6) : "");
    csv += "," + (row.peak_memory_mib ? fixed_text(*row.peak_memory_mib, 1) : "");
    csv += "," + csv_text(row.cell) + "\n";
  }
  return csv;
}

void choose_cells(ResultsRecord& results, const std::vector<std::string>& only) {
  if (only.empty()) return;
  std::vector<std::string> names;
  for (const Cell& cell : results.cells) names.push_back(cell.sequence + "/" + cell.name);
  const std::vector<bool> chosen = select_cells({only}, names, "run");
  std::vector<Cell> left;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (chosen[i]) left.push_back(std::move(results.cells[i]));
  }
  results.cells = std::move(left);
  const auto has_cell = [&](std::string Cell::*part, const std::string& name) {
    return std::any_of(results.cells.begin(), results.cells.end(),
                       [&](const Cell& cell) { return cell.*part == name; });
  };
  std::erase_if(results.run.sequences,
                [&](const auto& item) { return !has_cell(&Cell::sequence, name_of(item)); });
  std::erase_if(results.run.methods,
                [&](const auto& item) { return !has_cell(&Cell::name, name_of(item)); });
  results.missing.clear();  // Those are of the whole run.
}

void choose_protocols(RunResults& results, const std::vector<std::string>& protocols) {
  const auto wanted = [&](const std::string& name) {
    return std::find(protocols.begin(), protocols.end(), name) != protocols.end();
  };
  for (const std::string& protocol : protocols) {
    const auto& known = results.protocols;
    if (std::find(known.begin(), known.end(), protocol) != known.end()) continue;
    throw UsageError("--protocol " + protocol + ": this run was not scored by it." +
                     suggestion(protocol, known));
  }
  if (protocols.empty()) return;
  std::erase_if(results.protocols, [&](const auto& name) { return !wanted(name); });
  std::erase_if(results.rows, [&](const ResultRow& row) { return !wanted(row.protocol); });
}

}  // namespace raymoval
