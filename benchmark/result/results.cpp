// SPDX-License-Identifier: MIT
#include "benchmark/result/results.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "benchmark/result/cell.h"
#include "benchmark/result/score_json.h"
#include "benchmark/suite/cell_selection.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

std::optional<double> optional_number(const ordered_json& json) {
  if (json.is_null()) return std::nullopt;
  return json.get<double>();
}

ResultRow row_head(const ordered_json& cell) {
  ResultRow row;
  row.sequence = cell.at("sequence").get<std::string>();
  row.cell = cell.at("name").get<std::string>();
  row.method = cell.at("method").at("name").get<std::string>();
  row.variant = cell.at("method").at("variant").get<std::string>();
  row.control = cell.at("method").at("control").get<bool>();
  row.status = cell.at("status").get<std::string>();
  if (cell.contains("masks") && cell.at("masks").contains("digest")) {
    row.mask_digest = cell.at("masks").at("digest").get<std::string>();
  }
  const ordered_json& measured = cell.at("measured");
  if (!measured.is_null()) {
    row.seconds_per_scan = optional_number(measured.at("seconds_per_scan").at("mean"));
    row.peak_memory_mib = optional_number(measured.at("peak_memory_mib"));
  }
  return row;
}

/// One row for each protocol of the suite, also where the cell failed.
void add_rows(const ordered_json& cell, RunResults& results) {
  for (const std::string& protocol : results.protocols) {
    ResultRow row = row_head(cell);
    row.protocol = protocol;
    for (const ordered_json& scored : cell.at("protocols")) {
      if (scored.at("name") != protocol) continue;
      for (const auto& [name, value] : scored.at("rates").items()) {
        row.rates[name] = optional_number(value);
      }
      add_intervals(scored, row);
    }
    results.rows.push_back(std::move(row));
  }
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

void add_times(const ordered_json& cell, RunResults& results) {
  const ordered_json& measured = cell.at("measured");
  if (cell.at("status") != "ok" || measured.is_null() || cell.at("method").at("control")) return;
  const auto name = cell.at("name").get<std::string>();
  MethodTimes* times = nullptr;
  for (MethodTimes& known : results.times) {
    if (known.cell == name) times = &known;
  }
  if (times == nullptr) {
    results.times.push_back({name, 0, 0.0, 0.0, {}, 1, 1});
    times = &results.times.back();
  }
  times->scans += cell.at("data").at("scans").get<std::size_t>();
  times->seconds += measured.at("seconds_total").get<double>();
  times->load_seconds += measured.at("seconds_load").get<double>();
  times->threads = std::max(times->threads, measured.value("threads", 1));
  if (measured.contains("repeats")) {
    times->repeats = static_cast<int>(measured.at("repeats").size());
  }
  for (const ordered_json& stage : measured.at("stages")) {
    add_stage(*times, stage.at("name").get<std::string>(), stage.at("seconds").get<double>());
  }
}

/// The last line of `text` that holds anything, without what would steer a terminal.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  text.erase(0, text.rfind('\n') + 1);
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  return text;
}

void add_failure(const ordered_json& cell, RunResults& results) {
  const auto status = cell.at("status").get<std::string>();
  if (status == "ok") return;
  results.failures.push_back(
      {cell.at("sequence").get<std::string>(), cell.at("name").get<std::string>(), status,
       cell.at("reason").get<std::string>(), last_line(cell.at("output_tail").get<std::string>())});
}

SweptCell swept_cell(const ordered_json& method) {
  SweptCell swept{
      method.at("name").get<std::string>(), method.at("sweep").at("of").get<std::string>(), {}};
  for (const auto& [key, value] : method.at("sweep").at("values").items()) {
    swept.values.emplace_back(key, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return swept;
}

RunResults parse(const ordered_json& json) {
  RunResults results;
  const ordered_json& suite = json.at("run").at("suite");
  results.name = suite.at("name").get<std::string>();
  for (const ordered_json& item : suite.at("sequences")) {
    results.sequences.push_back(item.at("name").get<std::string>());
  }
  for (const ordered_json& item : suite.at("methods")) {
    results.cells.push_back(item.at("name").get<std::string>());
    if (item.contains("sweep")) results.sweeps.push_back(swept_cell(item));
  }
  for (const ordered_json& item : suite.at("protocols")) {
    results.protocols.push_back(item.at("name").get<std::string>());
    results.protocol_kinds[results.protocols.back()] = item.at("protocol").get<std::string>();
  }
  for (const ordered_json& cell : json.at("cells")) {
    add_rows(cell, results);
    add_columns(cell, results);
    add_times(cell, results);
    add_failure(cell, results);
  }
  if (json.contains("missing")) json.at("missing").get_to(results.missing);
  results.control_problems = json.at("controls").at("problems").get<std::vector<std::string>>();
  return results;
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

RunResults parse_results(const ordered_json& results, const std::string& where) {
  try {
    if (results.at("schema_version") != kSchemaVersion) {
      throw DataError(where + ": schema version " + results.at("schema_version").dump() +
                      ", expected " + std::to_string(kSchemaVersion) +
                      ". Run `raymoval run` again with this version.");
    }
    return parse(results);
  } catch (const ordered_json::exception& error) {
    throw DataError(where + ": not the results of a run (" + error.what() +
                    "). Run `raymoval run` again with the same --out.");
  }
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

void choose_cells(ordered_json& results, const std::vector<std::string>& only) {
  if (only.empty()) return;
  std::vector<std::string> names;
  ordered_json& cells = results.at("cells");
  for (const ordered_json& cell : cells) {
    names.push_back(cell.at("sequence").get<std::string>() + "/" +
                    cell.at("name").get<std::string>());
  }
  const std::vector<bool> chosen = select_cells({only}, names, "run");
  ordered_json left = ordered_json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (chosen[i]) left.push_back(cells[i]);
  }
  ordered_json& suite = results.at("run").at("suite");
  for (const auto& [list, key] :
       {std::pair("sequences", "sequence"), std::pair("methods", "name")}) {
    ordered_json kept = ordered_json::array();
    for (const ordered_json& item : suite.at(list)) {
      const bool there = std::any_of(left.begin(), left.end(), [&, key = key](const auto& cell) {
        return cell.at(key) == item.at("name");
      });
      if (there) kept.push_back(item);
    }
    suite.at(list) = std::move(kept);
  }
  cells = std::move(left);
  results.erase("missing");  // Those are of the whole run.
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
