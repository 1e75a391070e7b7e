// SPDX-License-Identifier: MIT
#include "benchmark/result/cell_json.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "benchmark/result/result_fields.h"
#include "core/files/files.h"

namespace raymoval {

using nlohmann::ordered_json;

namespace {

/// Why a rate is undefined. Such a rate is null in the file, and its reason is in a separate
/// object.
std::string reason_of(const Named<std::string>& reasons, const std::string& name) {
  for (const auto& [known, reason] : reasons) {
    if (known == name) return reason;
  }
  return "";
}

}  // namespace

void describe_rates(RecordWriter& writer, const std::vector<Rate>& rates) {
  Named<std::optional<double>> values;
  Named<std::string> reasons;
  for (const Rate& rate : rates) {
    const bool defined = rate.value && std::isfinite(*rate.value);
    values.emplace_back(rate.name, defined ? rate.value : std::nullopt);
    if (!defined) reasons.emplace_back(rate.name, rate.undefined_reason);
  }
  writer.field("rates", values);
  writer.field("undefined", reasons);
}

void describe_rates(RecordReader& reader, std::vector<Rate>& rates) {
  Named<std::optional<double>> values;
  Named<std::string> reasons;
  reader.field("rates", values);
  reader.field("undefined", reasons);
  for (const auto& [name, value] : values) {
    rates.push_back({name, value, reason_of(reasons, name)});
  }
}

void describe_rates(RecordWriter& writer, const std::vector<Interval>& rates) {
  Named<std::optional<std::pair<double, double>>> ends;
  Named<std::string> reasons;
  for (const Interval& rate : rates) {
    auto& both = ends.emplace_back(rate.name, std::nullopt).second;
    if (rate.low && rate.high) both.emplace(*rate.low, *rate.high);
    if (!both) reasons.emplace_back(rate.name, rate.undefined_reason);
  }
  writer.field("rates", ends);
  writer.field("undefined", reasons);
}

void describe_rates(RecordReader& reader, std::vector<Interval>& rates) {
  Named<std::optional<std::pair<double, double>>> ends;
  Named<std::string> reasons;
  reader.field("rates", ends);
  reader.field("undefined", reasons);
  for (const auto& [name, both] : ends) {
    Interval& rate = rates.emplace_back();
    rate.name = name;
    if (both) std::tie(rate.low, rate.high) = *both;
    rate.undefined_reason = reason_of(reasons, name);
  }
}

void describe(RecordWriter& writer, const ColumnRecord& columns) {
  Named<ColumnValue> values;
  for (const ColumnValue& column : columns.values) values.emplace_back(column.name, column);
  writer.field("version", columns.version);
  writer.field("values", values);
}

void describe(RecordReader& reader, ColumnRecord& columns) {
  Named<ColumnValue> values;
  reader.field("version", columns.version);
  reader.field("values", values);
  for (auto& [name, column] : values) {
    columns.values.push_back(std::move(column));
    columns.values.back().name = name;
  }
}

void describe(RecordWriter& writer, const Reliability& reliability) {
  writer.field("bins",
               std::vector<ReliabilityBin>(reliability.bins.begin(), reliability.bins.end()));
  writer.field("expected_calibration_error", reliability.expected_error());
  writer.field("mean_gap", reliability.mean_gap());
}

void describe(RecordReader& reader, Reliability& reliability) {
  std::vector<ReliabilityBin> bins;
  reader.field("bins", bins);
  std::optional<double> error, gap;  // They follow from the bins.
  for (const char* key : {"expected_calibration_error", "mean_gap"}) reader.require(key);
  reader.nullable("expected_calibration_error", error);
  reader.nullable("mean_gap", gap);
  if (bins.size() != reliability.bins.size()) {
    reader.fail("confidence.bins", "expected " + std::to_string(kConfidenceBins) + " of them");
  }
  std::copy(bins.begin(), bins.end(), reliability.bins.begin());
}

Cell read_cell(const std::filesystem::path& file) {
  return read_sealed_with(file, read_as<Cell>);
}

void write_cell(const std::filesystem::path& file, const Cell& cell) {
  write_sealed(file, to_json(cell));
}

std::string cell_key(const CellIdentity& identity) {
  return content_hash(json_text(to_json(identity)));
}

std::string value_text(const ParameterValue& value) {
  const auto text_of = [](const auto& held) {
    return ordered_json(held).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  };
  return std::visit(text_of, value);
}

std::string plain_text(const ParameterValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr ? *text : value_text(value);
}

}  // namespace raymoval
