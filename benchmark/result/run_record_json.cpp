// SPDX-License-Identifier: MIT
#include "benchmark/result/run_record_json.h"

#include <nlohmann/json.hpp>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/json_fields.h"
#include "benchmark/suite/suite_json.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

ordered_json suite_method_json(const SuiteMethodRecord& method) {
  ordered_json json;
  json["name"] = method.name;
  json["method"] = method.method;
  json["version"] = method.version;
  json["parameters"] = to_json(method.parameters);
  if (!method.sweep.empty()) {
    json["sweep"]["of"] = method.sweep_of;
    json["sweep"]["values"] = to_json(method.sweep);
  }
  return json;
}

ordered_json suite_json(const RunRecord& run) {
  ordered_json json;
  json["name"] = run.suite;
  json["sequences"] = ordered_json::array();
  for (const SequenceRecord& sequence : run.sequences) {
    json["sequences"].push_back(to_json(sequence.data));
  }
  json["methods"] = ordered_json::array();
  for (const SuiteMethodRecord& method : run.methods)
    json["methods"].push_back(suite_method_json(method));
  json["protocols"] = ordered_json::array();
  for (const ProtocolRecord& protocol : run.protocols) {
    json["protocols"].push_back(to_json(protocol));
  }
  json["controls"] = run.controls;
  return json;
}

ordered_json build_json(const RunRecord& run) {
  if (!run.build) return nullptr;
  ordered_json json;
  json["version"] = run.build->version;
  if (!run.build->commit.empty()) json["commit"] = run.build->commit;
  if (!run.build->source_tree.empty()) json["source_tree"] = run.build->source_tree;
  json["compiler"] = run.build->compiler;
  json["build_type"] = run.build->build_type;
  return json;
}

ordered_json machine_json(const RunRecord& run) {
  if (!run.machine) return nullptr;
  ordered_json json;
  json["processor"] = run.machine->processor;
  json["cores"] = run.machine->cores;
  json["memory_gib"] = nullptr;
  if (run.machine->memory_gib) json["memory_gib"] = *run.machine->memory_gib;
  json["threads"] = run.machine->threads;
  return json;
}

/// What run.json and the part "run" of results.json have in common; the cells are put between.
ordered_json run_json(const RunRecord& run, ordered_json cells) {
  ordered_json json;
  json["schema_version"] = kSchemaVersion;
  json["suite"] = suite_json(run);
  if (!cells.is_null()) json["cells"] = std::move(cells);
  json["build"] = build_json(run);
  json["machine"] = machine_json(run);
  return json;
}

SuiteMethodRecord suite_method_from(const JsonFields& fields) {
  SuiteMethodRecord method{fields.get<std::string>("name"), fields.get<std::string>("method"),
                           fields.get<std::string>("version"),
                           fields.named<ParameterValue>("parameters")};
  if (const auto sweep = fields.find<JsonFields>("sweep")) {
    method.sweep_of = sweep->get<std::string>("of");
    method.sweep = sweep->named<ParameterValue>("values");
  }
  return method;
}

void read_suite_fields(const JsonFields& fields, RunRecord& run) {
  run.suite = fields.get<std::string>("name");
  for (const JsonFields& sequence : fields.list<JsonFields>("sequences")) {
    run.sequences.push_back({data_from(sequence)});
  }
  for (const JsonFields& method : fields.list<JsonFields>("methods")) {
    run.methods.push_back(suite_method_from(method));
  }
  for (const JsonFields& protocol : fields.list<JsonFields>("protocols")) {
    run.protocols.push_back(protocol_from(protocol));
  }
  run.controls = fields.get<bool>("controls");
}

/// The parts of a run that do not depend on where it stands.
RunRecord run_from(const JsonFields& fields) {
  RunRecord run;
  read_suite_fields(fields.get<JsonFields>("suite"), run);
  if (const auto build = fields.find<JsonFields>("build")) {
    run.build = {build->get<std::string>("version"),
                 build->find<std::string>("commit").value_or(""),
                 build->find<std::string>("source_tree").value_or(""),
                 build->get<std::string>("compiler"), build->get<std::string>("build_type")};
  }
  if (const auto machine = fields.find<JsonFields>("machine")) {
    run.machine = {machine->get<std::string>("processor"), machine->get<int>("cores"),
                   machine->find<std::int64_t>("memory_gib"), machine->get<int>("threads")};
  }
  return run;
}

}  // namespace

/// Where a sequence was found, which an earlier version may not have said.
template <>
std::optional<SequenceRequest> JsonFields::read(const ordered_json& json,
                                                const std::string& place) const {
  if (json.is_null()) return std::nullopt;
  try {
    return place_from(json);
  } catch (const std::exception& error) {
    fail_at(place, error.what());
  }
}

ordered_json to_json(const RunRecord& run) {
  ordered_json cells = ordered_json::array();
  for (const CellName& cell : run.cells) {
    cells.push_back({{"sequence", cell.sequence}, {"name", cell.name}});
  }
  ordered_json json = run_json(run, std::move(cells));
  for (const SequenceRecord& sequence : run.sequences) {
    json["places"].push_back(sequence.place ? to_json(*sequence.place) : nullptr);
  }
  return json;
}

RunRecord run_record_from(const JsonFields& fields) {
  RunRecord run = run_from(fields);
  if (fields.has("places")) {
    const auto places = fields.list<std::optional<SequenceRequest>>("places");
    if (places.size() != run.sequences.size()) fields.fail("places", "is not one of each sequence");
    for (std::size_t i = 0; i < places.size(); ++i) run.sequences[i].place = places[i];
  }
  // Earlier versions did not list the cells: there each sequence goes with each method.
  if (!fields.has("cells")) run.cells = run.all_cells();
  if (fields.has("cells")) {
    for (const JsonFields& cell : fields.list<JsonFields>("cells")) {
      run.cells.push_back({cell.get<std::string>("sequence"), cell.get<std::string>("name")});
    }
  }
  return run;
}

RunRecord read_run_record(const std::filesystem::path& file) {
  return read_sealed_as(file, run_record_from);
}

void write_run_record(const std::filesystem::path& file, const RunRecord& run) {
  write_sealed(file, to_json(run));
}

ordered_json to_json(const ResultsRecord& results) {
  ordered_json json;
  json["schema_version"] = kSchemaVersion;
  json["run"] = run_json(results.run, nullptr);
  json["controls"]["checked"] = results.controls_checked;
  json["controls"]["problems"] = results.control_problems;
  if (!results.missing.empty()) json["missing"] = results.missing;
  json["cells"] = ordered_json::array();
  for (const Cell& cell : results.cells) json["cells"].push_back(to_json(cell));
  return json;
}

ResultsRecord results_from(const JsonFields& fields) {
  ResultsRecord results;
  results.run = run_from(fields.get<JsonFields>("run"));
  const auto controls = fields.get<JsonFields>("controls");
  results.controls_checked = controls.get<bool>("checked");
  results.control_problems = controls.list<std::string>("problems");
  if (fields.has("missing")) results.missing = fields.list<std::string>("missing");
  for (const JsonFields& cell : fields.list<JsonFields>("cells")) {
    results.cells.push_back(cell_from(cell));
  }
  return results;
}

ResultsRecord read_results(const std::filesystem::path& file) {
  return read_sealed_as(file, results_from);
}

void write_results(const std::filesystem::path& file, const ResultsRecord& results) {
  write_sealed(file, to_json(results));
}

std::string read_results_text(const std::filesystem::path& file) {
  (void)read_results(file);
  return json_text(read_sealed(file));
}

}  // namespace raymoval
