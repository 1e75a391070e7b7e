// SPDX-License-Identifier: MIT
#include "benchmark/result/cell_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "benchmark/result/json_fields.h"
#include "core/files/files.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

template <class Value>
ordered_json value_or_null(const std::optional<Value>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

template <class Record>
ordered_json record_or_null(const std::optional<Record>& record) {
  return record ? to_json(*record) : ordered_json(nullptr);
}

ordered_json intervals_json(const Intervals& intervals) {
  ordered_json json;
  json["level"] = intervals.options.level;
  json["replicates"] = intervals.options.replicates;
  json["seed"] = intervals.options.seed;
  json["block_scans"] = intervals.block_scans;
  json["rates"] = ordered_json::object();
  json["undefined"] = ordered_json::object();
  for (const Interval& interval : intervals.rates) {
    const bool defined = interval.low && interval.high;
    json["rates"][interval.name] =
        defined ? ordered_json::array({*interval.low, *interval.high}) : ordered_json(nullptr);
    if (!defined) json["undefined"][interval.name] = interval.undefined_reason;
  }
  return json;
}

/// Adds what a protocol says. @param result a Score or a ProtocolResult
template <class Result>
void add_result(ordered_json& json, const Result& result) {
  json["counts"] = ordered_json::object();
  for (const auto& [name, count] : result.counts) json["counts"][name] = count;
  json["rates"] = ordered_json::object();
  json["undefined"] = ordered_json::object();
  for (const Rate& rate : result.rates) {
    const bool defined = rate.value.has_value() && std::isfinite(*rate.value);
    json["rates"][rate.name] = defined ? ordered_json(*rate.value) : nullptr;
    if (!defined) json["undefined"][rate.name] = rate.undefined_reason;
  }
  json["warnings"] = result.warnings;
  if (result.intervals) json["intervals"] = intervals_json(*result.intervals);
}

ordered_json score_json(const Score& score) {
  ordered_json json = to_json(score.protocol);
  add_result(json, score);
  return json;
}

/// Why a rate or column has no value.
std::string undefined_reason(const JsonFields& fields, const std::string& name) {
  return fields.get<JsonFields>("undefined").find<std::string>(name.c_str()).value_or("");
}

MethodRecord method_from(const JsonFields& fields) {
  return {fields.get<std::string>("name"),    fields.get<std::string>("variant"),
          fields.get<std::string>("version"), fields.get<bool>("online"),
          fields.get<bool>("control"),        fields.named<ParameterValue>("parameters")};
}

Intervals intervals_from(const JsonFields& fields) {
  Intervals intervals;
  intervals.options.level = fields.get<double>("level");
  intervals.options.replicates = fields.get<int>("replicates");
  intervals.options.seed = fields.get<std::uint64_t>("seed");
  intervals.block_scans = fields.get<std::uint64_t>("block_scans");
  for (const auto& [name, ends] : fields.named<std::optional<std::pair<double, double>>>("rates")) {
    Interval interval{name, std::nullopt, std::nullopt};
    if (ends) std::tie(interval.low, interval.high) = *ends;
    if (!ends) interval.undefined_reason = undefined_reason(fields, name);
    intervals.rates.push_back(std::move(interval));
  }
  return intervals;
}

Score score_from(const JsonFields& fields) {
  Score score{protocol_from(fields)};
  score.protocol.version = fields.get<std::string>("version");
  score.counts = fields.named<std::int64_t>("counts");
  for (const auto& [name, value] : fields.named<std::optional<double>>("rates")) {
    score.rates.push_back({name, value, value ? "" : undefined_reason(fields, name)});
  }
  score.warnings = fields.list<std::string>("warnings");
  const auto intervals = fields.find<JsonFields>("intervals");
  if (intervals) score.intervals = intervals_from(*intervals);
  return score;
}

ColumnRecord columns_from(const JsonFields& fields) {
  ColumnRecord columns{fields.get<std::string>("version"), {}};
  for (const auto& [name, value] : fields.named<JsonFields>("values")) {
    (void)value.get<std::optional<double>>("percent");  // It follows from the counts.
    columns.values.push_back({name,
                              {value.get<std::int64_t>("part"), value.get<std::int64_t>("whole")},
                              value.find<std::string>("undefined").value_or("")});
  }
  return columns;
}

LabelRule label_rule_from(const JsonFields& fields) {
  LabelRule rule{fields.get<std::string>("name"), {}, {}};
  const auto read_ids = [&](const char* key, std::vector<std::uint16_t>& ids) {
    for (const std::uint64_t id : fields.list<std::uint64_t>(key)) {
      if (id > 0xFFFF) fields.fail(key, "a label id is above 65535");
      ids.push_back(static_cast<std::uint16_t>(id));
    }
  };
  read_ids("moving", rule.moving);
  read_ids("ignored", rule.ignored);
  return rule;
}

}  // namespace

ordered_json to_json(const DataRecord& data) {
  ordered_json json;
  json["name"] = data.name;
  json["layout"] = data.layout;
  json["source"] = data.source;
  json["frames"] = data.frames;
  json["scans"] = data.scans;
  json["poses"] = data.poses;
  json["sensor"] = data.sensor;
  if (!data.sensor_basis.empty()) json["sensor_basis"] = data.sensor_basis;
  if (!data.up.empty()) json["up"] = data.up;
  if (!data.up_source.empty()) json["up_source"] = data.up_source;
  json["scan_period_s"] = value_or_null(data.scan_period_s);
  json["range_m"] = {{"min", data.range_m.min}, {"max", nullptr}};
  if (data.range_m.max < RangeLimits{}.max) json["range_m"]["max"] = data.range_m.max;
  if (data.drop_ego) {
    json["drop_ego"] = {{"asked", data.drop_ego->asked}, {"left_out", data.drop_ego->left_out}};
  }
  json["label_rule"] = record_or_null(data.label_rule);
  if (!data.fingerprint.empty()) json["fingerprint"] = data.fingerprint;
  return json;
}

DataRecord data_from(const JsonFields& fields) {
  DataRecord data{
      fields.get<std::string>("name"),    fields.get<std::string>("layout"),
      fields.get<std::string>("source"),  fields.get<std::string>("frames"),
      fields.get<std::uint64_t>("scans"), fields.get<std::string>("poses"),
      fields.get<std::string>("sensor"),  fields.find<std::string>("sensor_basis").value_or("")};
  data.up = fields.find<std::string>("up").value_or("");
  data.up_source = fields.find<std::string>("up_source").value_or("");
  data.scan_period_s = fields.find<double>("scan_period_s");
  const auto range = fields.get<JsonFields>("range_m");
  data.range_m.min = range.get<double>("min");
  data.range_m.max = range.find<double>("max").value_or(RangeLimits{}.max);
  if (const auto ego = fields.find<JsonFields>("drop_ego")) {
    data.drop_ego = {ego->get<std::string>("asked"), ego->get<std::string>("left_out")};
  }
  const auto rule = fields.find<JsonFields>("label_rule");
  if (rule) data.label_rule = label_rule_from(*rule);
  data.fingerprint = fields.find<std::string>("fingerprint").value_or("");
  return data;
}

ordered_json to_json(const MethodRecord& method) {
  ordered_json json;
  json["name"] = method.name;
  json["variant"] = method.variant;
  json["version"] = method.version;
  json["online"] = method.online;
  json["control"] = method.control;
  json["parameters"] = to_json(method.parameters);
  return json;
}

ordered_json to_json(const ProtocolRecord& protocol) {
  ordered_json json;
  json["name"] = protocol.name;
  json["protocol"] = protocol.protocol;
  if (!protocol.version.empty()) json["version"] = protocol.version;
  json["options"] = to_json(protocol.options);
  return json;
}

ProtocolRecord protocol_from(const JsonFields& fields) {
  return {fields.get<std::string>("name"), fields.get<std::string>("protocol"),
          fields.find<std::string>("version").value_or(""),
          fields.named<ParameterValue>("options")};
}

ordered_json to_json(const ProtocolResult& result) {
  ordered_json json;
  add_result(json, result);
  return json;
}

ordered_json to_json(const ColumnRecord& columns) {
  ordered_json json;
  json["version"] = columns.version;
  json["values"] = ordered_json::object();
  for (const ColumnValue& column : columns.values) {
    ordered_json& value = json["values"][column.name];
    value["part"] = column.share.part;
    value["whole"] = column.share.whole;
    const std::optional<double> percent = column.share.percent();
    value["percent"] = value_or_null(percent);
    if (!percent) value["undefined"] = column.undefined_reason;
  }
  return json;
}

ordered_json to_json(const Measurement& measured) {
  ordered_json json;
  json["threads"] = measured.threads;
  ordered_json& by_scan = json["seconds_per_scan"];
  by_scan["mean"] = measured.mean_seconds;
  by_scan["median"] = value_or_null(measured.median_seconds);
  by_scan["p90"] = value_or_null(measured.p90_seconds);
  by_scan["early"] = value_or_null(measured.early_seconds);
  by_scan["late"] = value_or_null(measured.late_seconds);
  json["seconds_total"] = measured.total_seconds;
  json["seconds_load"] = measured.load_seconds;
  json["stages"] = ordered_json::array();
  for (const StageSeconds& stage : measured.stages) {
    json["stages"].push_back({{"name", stage.name}, {"seconds", stage.seconds}});
  }
  json["peak_memory_mib"] = value_or_null(measured.peak_memory_mib);
  if (!measured.repeats.empty()) json["repeats"] = measured.repeats;
  return json;
}

Measurement measurement_from(const JsonFields& fields) {
  Measurement measured;
  measured.threads = fields.get<int>("threads");
  const auto by_scan = fields.get<JsonFields>("seconds_per_scan");
  measured.mean_seconds = by_scan.get<double>("mean");
  measured.median_seconds = by_scan.find<double>("median");
  measured.p90_seconds = by_scan.find<double>("p90");
  measured.early_seconds = by_scan.find<double>("early");
  measured.late_seconds = by_scan.find<double>("late");
  measured.total_seconds = fields.get<double>("seconds_total");
  measured.load_seconds = fields.get<double>("seconds_load");
  for (const JsonFields& stage : fields.list<JsonFields>("stages")) {
    measured.stages.push_back({stage.get<std::string>("name"), stage.get<double>("seconds")});
  }
  measured.peak_memory_mib = fields.find<double>("peak_memory_mib");
  if (fields.has("repeats")) measured.repeats = fields.list<double>("repeats");
  return measured;
}

ordered_json to_json(const Cell& cell) {
  ordered_json json;
  json["schema_version"] = kSchemaVersion;
  json["sequence"] = cell.sequence;
  json["name"] = cell.name;
  json["key"] = cell.key.empty() ? ordered_json(nullptr) : ordered_json(cell.key);
  json["status"] = status_name(cell.status);
  json["reason"] = cell.reason;
  json["output_tail"] = cell.output_tail;
  json["method"] = to_json(cell.method);
  json["data"] = record_or_null(cell.data);
  json["protocols"] = ordered_json::array();
  for (const Score& score : cell.scores) json["protocols"].push_back(score_json(score));
  json["columns"] = record_or_null(cell.columns);
  json["masks"] = nullptr;
  if (cell.masks) {
    json["masks"] = {{"digest", cell.masks->digest}, {"removed", cell.masks->removed}};
  }
  json["measured"] = record_or_null(cell.measured);
  return json;
}

Cell cell_from(const JsonFields& fields) {
  Cell cell{fields.get<std::string>("sequence"), fields.get<std::string>("name"),
            fields.find<std::string>("key").value_or("")};
  const auto status = fields.get<std::string>("status");
  if (!status_called(status)) fields.fail("status", "'" + status + "' is no status of a cell");
  cell.status = *status_called(status);
  cell.reason = fields.get<std::string>("reason");
  cell.output_tail = fields.get<std::string>("output_tail");
  cell.method = method_from(fields.get<JsonFields>("method"));
  if (const auto data = fields.find<JsonFields>("data")) cell.data = data_from(*data);
  for (const JsonFields& score : fields.list<JsonFields>("protocols")) {
    cell.scores.push_back(score_from(score));
  }
  if (const auto columns = fields.find<JsonFields>("columns")) {
    cell.columns = columns_from(*columns);
  }
  if (const auto masks = fields.find<JsonFields>("masks")) {
    cell.masks = {masks->get<std::string>("digest"), masks->get<std::int64_t>("removed")};
  }
  if (const auto measured = fields.find<JsonFields>("measured")) {
    cell.measured = measurement_from(*measured);
  }
  return cell;
}

Cell read_cell(const std::filesystem::path& file) {
  return read_sealed_as(file, cell_from);
}

void write_cell(const std::filesystem::path& file, const Cell& cell) {
  write_sealed(file, to_json(cell));
}

RepeatRecord read_repeat(const std::filesystem::path& file) {
  return read_sealed_as(file, [](const JsonFields& fields) {
    return RepeatRecord{fields.get<std::string>("key"), fields.get<int>("repeat"),
                        fields.get<std::string>("digest"),
                        measurement_from(fields.get<JsonFields>("measured"))};
  });
}

void write_repeat(const std::filesystem::path& file, const RepeatRecord& repeat) {
  ordered_json json;
  json["schema_version"] = kSchemaVersion;
  json["key"] = repeat.key;
  json["repeat"] = repeat.number;
  json["digest"] = repeat.digest;
  json["measured"] = to_json(repeat.measured);
  write_sealed(file, std::move(json));
}

std::string cell_key(const CellIdentity& identity) {
  ordered_json json;
  json["schema_version"] = kSchemaVersion;
  json["method"] = to_json(identity.method);
  json["data"] = to_json(identity.data);
  json["columns"]["version"] = kColumnsVersion;
  for (const ProtocolRecord& protocol : identity.protocols) {
    json["protocols"].push_back(to_json(protocol));
  }
  return content_hash(json_text(json));
}

std::string value_text(const ParameterValue& value) {
  const auto text_of = [](const auto& held) {
    return ordered_json(held).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  };
  return std::visit(text_of, value);
}

}  // namespace raymoval
