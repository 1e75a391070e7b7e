// SPDX-License-Identifier: MIT
#include "benchmark/result/score_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace raymoval {

using nlohmann::ordered_json;

ordered_json columns_record(const std::vector<ColumnValue>& columns) {
  ordered_json record;
  record["version"] = kColumnsVersion;
  record["values"] = ordered_json::object();
  for (const ColumnValue& column : columns) {
    ordered_json& value = record["values"][column.name];
    value["part"] = column.share.part;
    value["whole"] = column.share.whole;
    const std::optional<double> percent = column.share.percent();
    value["percent"] = percent ? ordered_json(*percent) : ordered_json(nullptr);
    if (!percent) value["undefined"] = column.undefined_reason;
  }
  return record;
}

ordered_json to_json(const Intervals& intervals) {
  ordered_json record;
  record["level"] = intervals.options.level;
  record["replicates"] = intervals.options.replicates;
  record["seed"] = intervals.options.seed;
  record["block_scans"] = intervals.block_scans;
  record["rates"] = ordered_json::object();
  record["undefined"] = ordered_json::object();
  for (const Interval& interval : intervals.rates) {
    const bool defined = interval.low && interval.high;
    record["rates"][interval.name] =
        defined ? ordered_json::array({*interval.low, *interval.high}) : ordered_json(nullptr);
    if (!defined) record["undefined"][interval.name] = interval.undefined_reason;
  }
  return record;
}

void add_intervals(const ordered_json& scored, ResultRow& row) {
  if (!scored.contains("intervals")) return;
  for (const auto& [name, ends] : scored.at("intervals").at("rates").items()) {
    if (!ends.is_null()) row.intervals[name] = {ends.at(0).get<double>(), ends.at(1).get<double>()};
  }
}

void add_columns(const ordered_json& cell, RunResults& results) {
  if (!cell.contains("columns") || cell.at("columns").is_null()) return;
  const auto name = cell.at("name").get<std::string>();
  const auto known = std::find_if(results.columns.begin(), results.columns.end(),
                                  [&](const MethodColumns& method) { return method.cell == name; });
  const auto place = static_cast<std::size_t>(known - results.columns.begin());
  if (known == results.columns.end()) {
    results.columns.push_back({name, cell.at("method").at("control").get<bool>(), 0, {}});
  }
  MethodColumns& method = results.columns[place];
  ++method.sequences;
  for (const auto& [column, value] : cell.at("columns").at("values").items()) {
    const auto same = [&key = column](const auto& entry) { return entry.first == key; };
    auto found = std::find_if(method.values.begin(), method.values.end(), same);
    if (found == method.values.end()) found = method.values.insert(found, {column, Share{}});
    found->second.part += value.at("part").get<std::int64_t>();
    found->second.whole += value.at("whole").get<std::int64_t>();
  }
}

Share MethodColumns::find(const std::string& name) const {
  for (const auto& [column, share] : values) {
    if (column == name) return share;
  }
  return {};
}

}  // namespace raymoval
