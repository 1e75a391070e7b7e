// SPDX-License-Identifier: MIT
#include "benchmark/run/run_folder.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "benchmark/process/machine.h"
#include "benchmark/result/cell.h"
#include "benchmark/result/results.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/run/cell_store.h"
#include "benchmark/suite/suite_json.h"
#include "benchmark/tables/tables.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;
using std::filesystem::path;

constexpr const char* kMarkerText =
    "This folder is one of `raymoval run --out`, which replaces its own files here and leaves\n"
    "all others alone.\n";

/// Whether a run writes a file of this name into its folder.
bool is_run_file(const path& name) {
  const std::string text = name.string();
  constexpr std::array kNames = {"run.json", "results.json", "results.csv",
                                 "table.md", "table.tex",    kRunMarker};
  return std::find(kNames.begin(), kNames.end(), text) != kNames.end();
}

/// "run.json.123.part", as earlier versions called what they had not finished.
bool is_part_of_earlier_version(const path& name) {
  const path number = name.stem().extension();
  return name.extension() == ".part" && number.string().size() > 1 &&
         parse_number<long>(number.string().substr(1)) && is_run_file(name.stem().stem());
}

bool is_lock(const path& entry) {
  if (entry.filename() != kLockFile || !is_file(entry)) return false;
  try {
    const std::string start = read_piece(entry, 0, 8);
    return start.empty() || start == "process ";
  } catch (const DataError&) {
    return false;  // Its holder took it away.
  }
}

/// A folder that holds folders only.
bool holds_cells(const path& entry) {
  if (entry.filename() != "cells" || !is_folder(entry)) return false;
  const std::vector<path> inside = entries_of(entry);
  return std::all_of(inside.begin(), inside.end(), is_folder);
}

/// What a run may leave before it marks its folder, or somebody who copies cells together.
bool may_be_ours(const path& entry) {
  return is_run_file(name_of_part(entry)) || is_part_of_earlier_version(entry.filename()) ||
         is_lock(entry) || holds_cells(entry);
}

/// Whether a run.json was written by a run and not changed since.
bool is_run_record(const path& file) {
  try {
    const ordered_json record = read_sealed(file);
    return record.contains("suite") && record.contains("build");
  } catch (const DataError&) {
    return false;
  }
}

/// @throws UsageError for a folder that may belong to somebody else
void check_is_run_folder(const path& out) {
  if (has_file(out / kRunMarker)) return;
  const std::string where = "--out " + out.string() + ": ";
  const std::string remedy =
      " Nothing was changed. Name a new or empty folder, or that of an earlier run to go on with "
      "it.";
  if (has_file(out / "run.json")) {
    if (is_run_record(out / "run.json")) return;  // Of an earlier version, which set no marker.
    throw UsageError(where + "its run.json is not as raymoval wrote it, so the folder may belong " +
                     "to another program." + remedy);
  }
  for (const path& entry : entries_of(out)) {
    if (may_be_ours(entry)) continue;
    if (has_file(out / kRunMarker)) return;  // Another process has begun here meanwhile.
    throw UsageError(where + "the folder holds other files (" + entry.filename().string() +
                     ") and no run." + remedy);
  }
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
    protocol["version"] = protocol_entry(request.protocol).version;
    protocol["options"] = to_json(request.options);
    record["protocols"].push_back(std::move(protocol));
  }
  record["controls"] = suite.controls;
  return record;
}

}  // namespace

void prepare_run_folder(const path& out) {
  if (has_folder(out)) check_is_run_folder(out);
  make_folder(out);
  if (!has_file(out / kRunMarker)) write_atomically(out / kRunMarker, kMarkerText);
}

void sweep_run_folder(const path& out) {
  for (const path& entry : entries_of(out)) {
    std::error_code ignored;
    if (is_run_file(name_of_part(entry))) std::filesystem::remove(entry, ignored);
  }
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
    record["places"].push_back(to_json(absolute_place(request)));
  }
  return record;
}

RunResults write_results(const path& out, const RunContent& content) {
  ordered_json results;
  results["schema_version"] = kSchemaVersion;
  results["run"] = *content.record;
  results["run"].erase("places");  // Results have no paths: they are copied and compared.
  results["run"].erase("cells");   // They have the cells themselves.
  results["controls"]["checked"] = content.controls_checked;
  results["controls"]["problems"] = content.control_problems;
  if (!content.missing.empty()) results["missing"] = content.missing;
  results["cells"] = *content.cells;
  RunResults parsed = parse_results(results, "results");
  const std::vector<TextTable> tables = make_tables(parsed);
  write_atomically(out / "results.csv", results_csv(parsed));
  write_atomically(out / "table.md", tables_markdown(parsed, tables));
  write_atomically(out / "table.tex", tables_latex(tables));
  write_sealed(out / "results.json", std::move(results));
  return parsed;
}

}  // namespace raymoval
