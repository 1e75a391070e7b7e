// SPDX-License-Identifier: MIT
#include "benchmark/runner.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "benchmark/cell.h"
#include "benchmark/checked_sink.h"
#include "benchmark/controls_check.h"
#include "benchmark/machine.h"
#include "benchmark/removal_files.h"
#include "benchmark/results.h"
#include "benchmark/sealed_json.h"
#include "benchmark/sequence_bench.h"
#include "benchmark/tables.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/text.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;
using std::filesystem::path;

void make_folder(const path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw DataError(folder.string() + ": cannot be made (" + error.message() +
                    "). Choose another --out.");
  }
}

/// Refuses to spread results over a folder that holds something else.
void prepare_run_folder(const path& out) {
  std::error_code ignored;
  if (std::filesystem::is_directory(out, ignored) && !std::filesystem::is_empty(out, ignored) &&
      !std::filesystem::exists(out / "run.json", ignored)) {
    throw UsageError("--out " + out.string() +
                     ": the folder holds other files and no run.json. Name a new or empty folder, "
                     "or that of an earlier run to go on with it.");
  }
  make_folder(out);
}

std::vector<Sequence> open_sequences(const Suite& suite, const OpenContext& context) {
  std::vector<Sequence> sequences;
  for (const SequenceRequest& request : suite.sequences) {
    sequences.push_back(open_sequence(request.path, request.options, context));
    check_has_labels(sequences.back());
    for (std::size_t i = 0; i + 1 < sequences.size(); ++i) {
      if (folder_name(sequences[i].name) == folder_name(sequences.back().name)) {
        throw UsageError("two sequences of this run are called '" + sequences.back().name +
                         "'. Give each its own \"name\" in a suite file.");
      }
    }
  }
  return sequences;
}

ordered_json suite_record(const Suite& suite, const std::vector<Sequence>& sequences) {
  ordered_json record;
  record["name"] = suite.name;
  record["sequences"] = ordered_json::array();
  for (const Sequence& sequence : sequences) record["sequences"].push_back(sequence.record());
  record["methods"] = ordered_json::array();
  for (const MethodRequest& request : suite.methods) {
    ordered_json method;
    method["name"] = request.name;
    method["method"] = request.method.full_name();
    method["version"] = request.method.entry->version;
    method["parameters"] = to_json(request.method.configuration);
    record["methods"].push_back(std::move(method));
  }
  record["protocols"] = ordered_json::array();
  for (const ProtocolRequest& request : suite.protocols) {
    ordered_json protocol;
    protocol["name"] = request.name;
    protocol["protocol"] = request.protocol;
    protocol["options"] = to_json(request.options);
    record["protocols"].push_back(std::move(protocol));
  }
  record["controls"] = suite.controls;
  return record;
}

/// Runs the cells of a suite one after another.
class Runner {
 public:
  Runner(const Suite& suite, const RunOptions& options)
      : suite_(suite),
        options_(options),
        threads_(suite.threads > 0 ? suite.threads : hardware_threads()) {}

  RunSummary run() {
    std::vector<Sequence> sequences =
        open_sequences(suite_, {threads_, options_.progress, options_.cancel});
    for (const ProtocolRequest& request : suite_.protocols) {
      (void)make_protocol(request.protocol, request.options);  // Bad options show before the work.
    }
    prepare_run_folder(options_.out);
    ordered_json record;
    record["schema_version"] = kSchemaVersion;
    record["suite"] = suite_record(suite_, sequences);
    record["build"] = build_record();
    record["machine"] = machine_record();
    record["machine"]["threads"] = threads_;
    write_sealed(options_.out / "run.json", record);
    for (Sequence& sequence : sequences) run_sequence(std::move(sequence));
    if (unreadable_ == sequences.size()) throw DataError(first_unreadable_);
    finish(record);
    return summary_;
  }

 private:
  void run_sequence(Sequence sequence) {
    const std::string name = sequence.name;
    SequenceBench bench(std::move(sequence), suite_.protocols, threads_, options_.progress);
    try {
      (void)bench.data_fingerprint();
    } catch (const DataError& error) {
      if (unreadable_++ == 0) first_unreadable_ = error.what();
      for (const MethodRequest& request : suite_.methods) {
        keep(name, request, unreadable_cell(name, request, error.what()));
      }
      return;
    }
    for (const MethodRequest& request : suite_.methods) run_cell(bench, request);
  }

  void run_cell(SequenceBench& bench, const MethodRequest& request) {
    if (options_.cancel != nullptr && options_.cancel->load()) throw Cancelled();
    const std::string& sequence = bench.sequence().name;
    const path folder = cell_folder(sequence, request);
    CellTask task{&bench, &request, {}, options_.cancel};
    if (options_.keep_removals) task.removals = folder / "removals";
    if (auto stored = stored_cell(task, folder)) {
      ++summary_.reused;
      keep_in_memory(sequence, request, std::move(*stored));
      return;
    }
    std::error_code ignored;
    std::filesystem::remove(folder / "cell.json", ignored);
    std::filesystem::remove_all(folder / "removals", ignored);
    keep(sequence, request, execute_cell(task));
  }

  [[nodiscard]] path cell_folder(const std::string& sequence, const MethodRequest& request) const {
    return options_.out / "cells" / folder_name(sequence) / folder_name(request.name);
  }

  /// The cell of an earlier run if it is this very cell, whole, and all that is asked for is there.
  [[nodiscard]] std::optional<ordered_json> stored_cell(const CellTask& task,
                                                        const path& folder) const {
    try {
      ordered_json cell = read_sealed(folder / "cell.json");
      if (cell.value("status", "") != "ok" || cell.value("key", "") != cell_key(task)) return {};
      if (!task.removals.empty()) {
        const MaskStore masks = read_removals(task.removals, *task.bench->sequence().scans, [] {});
        if (mask_digest(masks) != cell.at("masks").at("digest")) return {};
      }
      return cell;
    } catch (const DataError&) {
      return {};
    } catch (const ordered_json::exception&) {
      return {};
    }
  }

  void keep(const std::string& sequence, const MethodRequest& request, ordered_json cell) {
    const path folder = cell_folder(sequence, request);
    make_folder(folder);
    write_sealed(folder / "cell.json", cell);
    keep_in_memory(sequence, request, std::move(cell));
  }

  void keep_in_memory(const std::string& sequence, const MethodRequest& request,
                      ordered_json cell) {
    ++summary_.cells;
    std::string line = "[" + std::to_string(summary_.cells) + "/" +
                       std::to_string(suite_.sequences.size() * suite_.methods.size()) + "] " +
                       request.name + " on " + sequence + ": " + outcome(cell);
    if (cell["status"] != "ok") {
      summary_.failures.push_back(sequence + " / " + request.name + ": " +
                                  cell["reason"].get<std::string>());
    }
    cells_.push_back(std::move(cell));
    if (options_.progress == nullptr) return;
    options_.progress->end();
    options_.progress->say(line);
  }

  static std::string outcome(const ordered_json& cell) {
    if (cell["status"] != "ok") {
      return cell["status"].get<std::string>() + ", " + cell["reason"].get<std::string>();
    }
    std::string text;
    for (const ordered_json& protocol : cell["protocols"]) {
      for (const auto& [rate, value] : protocol["rates"].items()) {
        text += text.empty() ? "" : ", ";
        text += rate + " " + (value.is_null() ? "n/a" : rate_text(rate, value.get<double>()));
      }
    }
    return text + " (" +
           fixed_text(cell["measured"]["seconds_per_scan"]["mean"].get<double>() * 1000.0, 1) +
           " ms per scan)";
  }

  void finish(const ordered_json& record) {
    if (suite_.controls) summary_.controls = check_controls(cells_);
    ordered_json results;
    results["schema_version"] = kSchemaVersion;
    results["run"] = record;
    results["controls"]["checked"] = suite_.controls;
    results["controls"]["problems"] = summary_.controls;
    results["cells"] = cells_;
    const RunResults parsed = parse_results(results, "results");
    const std::vector<TextTable> tables = make_tables(parsed);
    write_atomically(options_.out / "results.csv", results_csv(parsed));
    write_atomically(options_.out / "table.md", tables_markdown(parsed, tables));
    write_atomically(options_.out / "table.tex", tables_latex(tables));
    write_sealed(options_.out / "results.json", std::move(results));
  }

  const Suite& suite_;
  const RunOptions& options_;
  int threads_;
  std::vector<ordered_json> cells_;
  RunSummary summary_;
  std::size_t unreadable_ = 0;
  std::string first_unreadable_;
};

}  // namespace

RunSummary run_suite(const Suite& suite, const RunOptions& options) {
  return Runner(suite, options).run();
}

}  // namespace raymoval
