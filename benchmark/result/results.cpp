// SPDX-License-Identifier: MIT
#include "benchmark/result/results.h"

#include <algorithm>

#include "benchmark/result/cell_json.h"
#include "benchmark/suite/cell_selection.h"
#include "core/text.h"
#include "eval/protocol_registry.h"
#include "methods/registry.h"

namespace raymoval {
namespace {

/// The item of a list for a cell; it is added if there is none.
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
    if (column.name == kWorstParked) {
      const auto worst = found->second.percent(), percent = column.share.percent();
      if (percent && (!worst || *percent < *worst)) found->second = column.share;
      continue;
    }
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
  for (const StageSeconds& stage : cell.measured->stages) {
    add_stage(times, stage.name, stage.seconds);
  }
}

/// Adds how the parameters of a method differ from its variant; points of a sweep add it once.
void add_changed(const SuiteMethodRecord& method, RunResults& results) {
  if (!method.changed_from) return;
  ChangedMethod changed{method.sweep ? method.sweep->of : method.name, ""};
  for (const auto& [key, value] : method.parameters) {
    for (const auto& [name, usual] : *method.changed_from) {
      if (name != key) continue;
      changed.differences += (changed.differences.empty() ? "" : ", ") + key + " = " +
                             plain_text(value) + " (default " + plain_text(usual) + ")";
    }
  }
  for (const ChangedMethod& known : results.changed) {
    if (known.name == changed.name) return;
  }
  results.changed.push_back(std::move(changed));
}

/// Adds the method if it is known on which data it was developed; points of a sweep add it once.
void add_developed(const SuiteMethodRecord& method, RunResults& results) {
  const std::string name = method.sweep ? method.sweep->of : method.name;
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    for (const MethodVariant& variant : entry->variants) {
      if (variant.developed_on.empty() || entry->name + ":" + variant.name != method.method)
        continue;
      std::vector<std::string>& names = results.developed_on[variant.developed_on];
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
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

const std::string& RunResults::kind_of(const std::string& protocol) const {
  const auto found = protocol_kinds.find(protocol);
  return found == protocol_kinds.end() ? protocol : found->second;
}

const Cell* RunResults::find(const std::string& sequence, const std::string& method) const {
  for (const Cell& cell : cells) {
    if (cell.sequence == sequence && cell.name == method) return &cell;
  }
  return nullptr;
}

const DataRecord* RunResults::data_of(const std::string& sequence) const {
  for (const Cell& cell : cells) {
    if (cell.sequence == sequence && cell.data) return &*cell.data;
  }
  return nullptr;
}

std::optional<double> RunResults::rate(const std::string& sequence, const std::string& method,
                                       const std::string& protocol, const std::string& rate) const {
  const Cell* cell = find(sequence, method);
  const Score* score = cell == nullptr ? nullptr : cell->score(protocol);
  return score == nullptr ? std::nullopt : score->rate(rate);
}

SegmentValues RunResults::values(const std::string& method, const std::string& protocol,
                                 const std::string& rate) const {
  SegmentValues list;
  for (const std::string& sequence : sequences) {
    list.push_back(this->rate(sequence, method, protocol, rate));
  }
  return list;
}

const SweptCell* RunResults::swept(const std::string& method) const {
  for (const SweptCell& point : sweeps) {
    if (point.cell == method) return &point;
  }
  return nullptr;
}

bool RunResults::is_control(const std::string& method) const {
  return std::ranges::any_of(
      cells, [&](const Cell& cell) { return cell.name == method && cell.method.control; });
}

std::optional<double> RunResults::ms_per_scan(const std::string& method) const {
  for (const MethodTimes& known : times) {
    if (known.cell != method || known.scans == 0) continue;
    return 1000.0 * known.seconds / static_cast<double>(known.scans);
  }
  return std::nullopt;
}

std::optional<double> RunResults::peak_mib(const std::string& method) const {
  std::optional<double> most;
  for (const Cell& cell : cells) {
    if (cell.name != method || !cell.measured || !cell.measured->peak_memory_mib) continue;
    most = std::max(most.value_or(0.0), *cell.measured->peak_memory_mib);
  }
  return most;
}

bool RunResults::gives(const std::string& protocol, const std::string& rate) const {
  return std::ranges::any_of(cells, [&](const Cell& cell) {
    const Score* score = cell.score(protocol);
    return score != nullptr &&
           std::ranges::any_of(score->rates, [&](const Rate& given) { return given.name == rate; });
  });
}

std::vector<std::string> RunResults::rates_of(const std::string& protocol) const {
  std::vector<std::string> rates;
  for (const RateSpec& spec : rate_specs()) {
    if (spec.role == RateRole::kSecondary) continue;
    if (gives(protocol, spec.name)) rates.push_back(spec.name);
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

const MethodColumns* RunResults::columns_of(const std::string& method) const {
  const auto found = std::ranges::find(columns, method, &MethodColumns::cell);
  return found == columns.end() ? nullptr : &*found;
}

RunResults shown_results(ResultsRecord results) {
  RunResults shown;
  shown.name = results.run.suite;
  shown.sequences = names_of(results.run.sequences);
  shown.methods = names_of(results.run.methods);
  shown.protocols = names_of(results.run.protocols);
  for (const ProtocolRecord& protocol : results.run.protocols) {
    shown.protocol_kinds[protocol.name] = protocol.protocol;
  }
  for (const SuiteMethodRecord& method : results.run.methods) {
    add_changed(method, shown);
    add_developed(method, shown);
    if (!method.sweep) continue;
    SweptCell swept{method.name, method.sweep->of, {}};
    for (const auto& [key, value] : method.sweep->values) {
      swept.values.emplace_back(key, plain_text(value));
    }
    shown.sweeps.push_back(std::move(swept));
  }
  for (Cell& cell : results.cells) {
    add_columns(cell, shown);
    add_reliability(cell, shown);
    add_times(cell, shown);
    for (Score& score : cell.scores) score.by_scan.clear();
  }
  shown.cells = std::move(results.cells);
  shown.missing = std::move(results.missing);
  shown.control_problems = std::move(results.control_problems);
  return shown;
}

std::vector<Sweep> sweeps_of(const RunResults& results) {
  std::vector<Sweep> sweeps;
  for (const SweptCell& point : results.sweeps) {
    const std::string name = point.sweep();
    // A parameter's name in a foreign run may hold a comma, so equal names are not enough.
    auto sweep = std::ranges::find_if(sweeps, [&](const Sweep& known) {
      return known.name == name && known.points.front()->values.size() == point.values.size();
    });
    if (sweep == sweeps.end()) sweep = sweeps.insert(sweep, {name, {}});
    sweep->points.push_back(&point);
  }
  return sweeps;
}

std::string results_csv(const RunResults& results) {
  std::vector<std::string> rates;
  for (const RateSpec& spec : rate_specs()) {
    if (spec.role != RateRole::kSecondary) rates.push_back(spec.name);
  }
  std::string csv = "sequence,method,variant,protocol,status," + join(rates, ",") +
                    ",parked,trails,seconds_per_scan,peak_memory_mib,name\n";
  for (const Cell& cell : results.cells) {
    for (const std::string& protocol : results.protocols) {
      csv += csv_text(cell.sequence) + "," + csv_text(cell.method.name) + "," +
             csv_text(cell.method.variant) + "," + csv_text(protocol) + "," +
             status_name(cell.status);
      const Score* score = cell.score(protocol);
      for (const std::string& rate : rates) {
        const auto value = score == nullptr ? std::nullopt : score->rate(rate);
        csv += "," + (value ? rate_text(rate, *value) : "");
      }
      for (const char* column : {kParked, kTrails}) {
        const auto percent = cell.columns ? cell.columns->find(column).percent() : std::nullopt;
        csv += "," + (percent ? fixed_text(*percent, 1) : "");
      }
      const Measurement measured = cell.measured.value_or(Measurement{});
      csv += "," + (cell.measured ? fixed_text(measured.mean_seconds, 6) : "") + ",";
      if (measured.peak_memory_mib) csv += fixed_text(*measured.peak_memory_mib, 1);
      csv += "," + csv_text(cell.name) + "\n";
    }
  }
  return csv;
}

void choose_cells(ResultsRecord& results, const std::vector<std::string>& only) {
  if (only.empty()) return;
  std::vector<std::string> names;
  for (const Cell& cell : results.cells) names.push_back(cell.sequence + "/" + cell.name);
  const std::vector<bool> chosen = select_cells(only, names, "run");
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
  results.missing.clear();  // They are those of the whole run.
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
}

}  // namespace raymoval
