// SPDX-License-Identifier: MIT
#include "benchmark/cli/commands/output_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/sealed_json.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

ordered_json value_json(const ParameterValue& value) {
  return std::visit([](const auto& held) { return ordered_json(held); }, value);
}

ordered_json bound_json(double bound) {
  return std::isfinite(bound) ? ordered_json(bound) : ordered_json(nullptr);
}

ordered_json variant_json(const MethodVariant& variant) {
  return {{"name", variant.name},
          {"sentence", variant.sentence},
          {"online", variant.online},
          {"overrides", to_json(variant.overrides)}};
}

ordered_json parameter_json(const ParameterSpec& spec) {
  return {{"name", spec.name},
          {"default", value_json(spec.default_value)},
          {"unit", spec.notes.unit},
          {"minimum", bound_json(spec.notes.minimum)},
          {"maximum", bound_json(spec.notes.maximum)},
          {"choices", spec.choices},
          {"source", spec.notes.source},
          {"sentence", spec.notes.sentence},
          {"acts_when", spec.notes.acts_when}};
}

ordered_json finding_json(const Finding& finding) {
  return {{"check", finding.check},       {"severity", severity_name(finding.severity)},
          {"where", finding.where},       {"what", finding.what},
          {"expected", finding.expected}, {"remedy", finding.remedy}};
}

ordered_json scored_json(const ScoredProtocol& scored) {
  ordered_json json = to_json(scored.protocol);
  json.update(to_json(scored.result));
  if (scored.oracle) json["oracle"] = to_json(*scored.oracle)["rates"];
  return json;
}

ordered_json cloud_json(const CloudRecord& cloud) {
  return {{"points", cloud.points},
          {"non_finite", cloud.non_finite},
          {"oracle_voxel_m", cloud.oracle_voxel_m},
          {"warnings", cloud.warnings}};
}

}  // namespace

const char* severity_name(Severity severity) {
  return severity == Severity::kNote ? "note" : "finding";
}

std::string output_json(const Description& description) {
  ordered_json variants = ordered_json::array();
  for (const MethodVariant& variant : description.variants) {
    variants.push_back(variant_json(variant));
  }
  ordered_json parameters = ordered_json::array();
  for (std::size_t i = 0; i < description.parameters.size(); ++i) {
    parameters.push_back(parameter_json(description.parameters[i]));
    if (!description.acts.empty()) parameters.back()["acts"] = bool{description.acts[i]};
  }
  ordered_json json = {{"name", description.name},           {"sentence", description.sentence},
                       {"source", description.source},       {"version", description.version},
                       {"notes", description.notes},         {"variants", std::move(variants)},
                       {"parameters", std::move(parameters)}};
  if (description.confidence) json["confidence"] = *description.confidence;
  return json_text(json);
}

std::string output_json_line(const PlannedCell& cell, bool looked) {
  ordered_json json = {{"cell", cell.cell.sequence + "/" + cell.cell.name},
                       {"key", cell.key.empty() ? ordered_json(nullptr) : ordered_json(cell.key)},
                       {"sequence", cell.cell.sequence},
                       {"name", cell.cell.name},
                       {"method", cell.method},
                       {"scans", cell.scans},
                       {"folder", cell.folder.generic_string()}};
  if (looked) json.update({{"to_run", cell.to_run}, {"why", cell.why}});
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string output_json(const InspectionReport& report) {
  ordered_json findings = ordered_json::array();
  for (const Finding& finding : report.findings) findings.push_back(finding_json(finding));
  ordered_json measures = ordered_json::object();
  for (const auto& [name, value] : report.measures) measures[name] = value;
  return json_text({{"sequence", report.sequence},
                    {"layout", report.layout},
                    {"scans", report.scans},
                    {"scans_read", report.scans_read},
                    {"sensor", report.sensor},
                    {"notes", report.notes},
                    {"findings", std::move(findings)},
                    {"measures", std::move(measures)}});
}

std::string output_json(const ScoreRecord& record) {
  ordered_json protocols = ordered_json::array();
  for (const ScoredProtocol& scored : record.protocols) protocols.push_back(scored_json(scored));
  ordered_json json = {{"schema_version", kSchemaVersion},
                       {"data", to_json(record.data)},
                       {"labels", record.cloud ? "nearest" : "index"},
                       {"protocols", std::move(protocols)}};
  if (record.cloud) json["cloud"] = cloud_json(*record.cloud);
  json["columns"] = to_json(record.columns);
  return json_text(json);
}

}  // namespace raymoval
