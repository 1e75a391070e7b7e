// SPDX-License-Identifier: MIT
#include "benchmark/run_folder.h"

#include <nlohmann/json.hpp>

#include "benchmark/cell.h"
#include "benchmark/cell_store.h"
#include "benchmark/machine.h"
#include "benchmark/results.h"
#include "benchmark/sealed_json.h"
#include "benchmark/sequence_place.h"
#include "benchmark/tables.h"
#include "core/files.h"
#include "eval/protocol.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;
using std::filesystem::path;

/// What a run may leave before it wrote its run.json, or somebody who copies cells together.
bool may_be_ours(const path& name) {
  return name == "cells" || name == kLockFile || name.extension() == ".part";
}

bool holds_something_else(const path& out) {
  std::error_code error;
  if (!std::filesystem::is_directory(out, error) || std::filesystem::exists(out / "run.json")) {
    return false;
  }
  for (const auto& entry : std::filesystem::directory_iterator(out, error)) {
    if (!may_be_ours(entry.path().filename())) return true;
  }
  return false;
}

ordered_json method_record(const MethodRequest& request) {
  ordered_json method;
  method["name"] = request.name;
  method["method"] = request.method.full_name();
  method["version"] = request.method.entry->version;
  method["parameters"] = to_json(request.method.configuration);
  if (!request.sweep.empty()) {
    method["sweep"]["of"] = request.sweep_of;
    method["sweep"]["values"] = to_json(request.sweep);
  }
  return method;
}

ordered_json suite_record(const Suite& suite, const std::vector<Sequence>& sequences) {
  ordered_json record;
  record["name"] = suite.name;
  record["sequences"] = ordered_json::array();
  for (const Sequence& sequence : sequences) record["sequences"].push_back(sequence.record());
  record["methods"] = ordered_json::array();
  for (const MethodRequest& request : suite.methods) {
    record["methods"].push_back(method_record(request));
  }
  record["protocols"] = ordered_json::array();
  for (const ProtocolRequest& request : suite.protocols) {
    ordered_json protocol;
    protocol["name"] = request.name;
    protocol["protocol"] = request.protocol;
    protocol["version"] = make_protocol(request.protocol, request.options)->version();
    protocol["options"] = to_json(request.options);
    record["protocols"].push_back(std::move(protocol));
  }
  record["controls"] = suite.controls;
  return record;
}

}  // namespace

void prepare_run_folder(const path& out) {
  if (holds_something_else(out)) {
    throw UsageError("--out " + out.string() +
                     ": the folder holds other files and no run.json. Name a new or empty folder, "
                     "or that of an earlier run to go on with it.");
  }
  make_folder(out);
}

ordered_json run_record(const Suite& suite, const std::vector<Sequence>& sequences, int threads) {
  ordered_json record;
  record["schema_version"] = kSchemaVersion;
  record["suite"] = suite_record(suite, sequences);
  record["cells"] = ordered_json::array();
  for (const Sequence& sequence : sequences) {
    for (const MethodRequest& request : suite.methods) {
      record["cells"].push_back({{"sequence", sequence.name}, {"name", request.name}});
    }
  }
  record["build"] = build_record();
  record["machine"] = machine_record();
  record["machine"]["threads"] = threads;
  for (const SequenceRequest& request : suite.sequences) {
    record["places"].push_back(place_record(absolute_place(request)));
  }
  return record;
}

void write_results(const path& out, const RunContent& content) {
  ordered_json results;
  results["schema_version"] = kSchemaVersion;
  results["run"] = *content.record;
  results["run"].erase("places");  // Results have no paths: they are copied and compared.
  results["run"].erase("cells");   // They have the cells themselves.
  results["controls"]["checked"] = content.controls_checked;
  results["controls"]["problems"] = content.control_problems;
  if (!content.missing.empty()) results["missing"] = content.missing;
  results["cells"] = *content.cells;
  const RunResults parsed = parse_results(results, "results");
  const std::vector<TextTable> tables = make_tables(parsed);
  write_atomically(out / "results.csv", results_csv(parsed));
  write_atomically(out / "table.md", tables_markdown(parsed, tables));
  write_atomically(out / "table.tex", tables_latex(tables));
  write_sealed(out / "results.json", std::move(results));
}

}  // namespace raymoval
