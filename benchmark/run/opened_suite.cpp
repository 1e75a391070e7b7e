// SPDX-License-Identifier: MIT
#include "benchmark/run/opened_suite.h"

#include <fmt/format.h>

#include "benchmark/process/method_run.h"
#include "benchmark/run/cell_run.h"
#include "benchmark/run/folder/run_folder.h"
#include "benchmark/suite/cell_selection.h"
#include "benchmark/suite/suite_json.h"
#include "core/files/file_kind.h"
#include "core/parallel.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// The sequences' names. Scenes are not generated, so that wrong names are reported before.
std::vector<std::string> sequence_names(const Suite& suite) {
  std::vector<std::string> names;
  for (const SequenceRequest& request : suite.sequences) {
    names.push_back(sequence_name(request.path, request.options));
    for (std::size_t i = 0; i + 1 < names.size(); ++i) {
      if (folder_name(names[i]) != folder_name(names.back())) continue;
      throw UsageError(fmt::format(
          "two sequences of this run are called '{}' ({} and {}). Run them into two folders, the "
          "second with --name NAME, or give each a \"name\" in a suite file.",
          names.back(), suite.sequences[i].path, request.path));
    }
  }
  return names;
}

std::vector<CellName> cell_names(const Suite& suite) {
  std::vector<CellName> cells;
  for (const std::string& sequence : sequence_names(suite)) {
    for (const MethodRequest& request : suite.methods) cells.push_back({sequence, request.name});
  }
  return cells;
}

/// "SEQUENCE/NAME" of each cell.
std::vector<std::string> selection_names(const std::vector<CellName>& cells) {
  std::vector<std::string> names;
  for (const CellName& cell : cells) names.push_back(cell.sequence + "/" + cell.name);
  return names;
}

void check_same_data(OpenedSuite& suite, std::size_t sequence, const RunRecord& present) {
  const std::string& name = suite.sequences()[sequence].name;
  if (known_fingerprint(present, name).empty() || !suite.is_needed(sequence)) return;
  ScoredSequence scored = suite.take_sequence(sequence);
  try {
    (void)scored.data_fingerprint();
  } catch (const DataError&) {
    return;  // Its cells get the error.
  }
  refuse_other_results(suite.options().out,
                       why_other_data(present, name, scored.data_fingerprint()));
  suite.give_back(sequence, std::move(scored));
}

}  // namespace

OpenedSuite::OpenedSuite(const Suite& suite, const RunOptions& options)
    : suite_(suite),
      options_(options),
      store_(options.out),
      threads_(options.jobs > 1    ? 1
               : suite.threads > 0 ? suite.threads
                                   : hardware_threads()) {
  if (options.jobs > 1 && suite.threads > 1) {
    throw UsageError(fmt::format(
        "--jobs {} gives each cell one thread, but {} threads are asked for; leave --threads (or "
        "\"threads\" of the suite) or --jobs out.",
        options.jobs, suite.threads));
  }
  for (const ProtocolRequest& request : suite.protocols) {
    (void)make_protocol(request.protocol,
                        request.options);  // Bad options are reported before the work.
  }
  cells_ = cell_names(suite);
  selected_ = select_cells(options.only, selection_names(cells_));
  for (const SequenceRequest& request : suite.sequences) {
    sequences_.push_back(
        open_sequence(request.path, request.options, {threads_, options.progress, options.cancel}));
    check_has_labels(sequences_.back());
  }
  check_paths_fit_json(suite);
  scored_sequences_.resize(sequences_.size());
}

void OpenedSuite::select_only(CellIndex cell) {
  alone_ = true;
  selected_.assign(selected_.size(), false);
  selected_[place(cell)] = true;
}

bool OpenedSuite::is_needed(std::size_t sequence) const {
  for (std::size_t method = 0; method < suite_.methods.size(); ++method) {
    const CellIndex cell{sequence, method};
    if (is_selected(cell)) return true;
    if (!alone_ && has_file(store_.folder(name(cell)) / "cell.json")) return true;
  }
  return false;
}

ScoredSequence OpenedSuite::take_sequence(std::size_t sequence) {
  if (auto& kept = scored_sequences_[sequence]) {
    ScoredSequence scored = std::move(*kept);
    kept.reset();
    return scored;
  }
  // Cells that run at once share one live line.
  Progress* progress = options_.jobs > 1 ? nullptr : options_.progress;
  return {sequences_[sequence], suite_.protocols, threads_, progress};
}

void OpenedSuite::give_back(std::size_t sequence, ScoredSequence scored) {
  scored_sequences_[sequence].emplace(std::move(scored));
}

StoredCell OpenedSuite::stored_cell(ScoredSequence& scored, CellIndex cell) const {
  const ScanSource* scans = options_.keep_removals ? scored.sequence().scans.get() : nullptr;
  const bool confidence = options_.confidence && !method(cell).method.entry->confidence.empty();
  return store_.find(name(cell), cell_identity(scored, method(cell)), scans, confidence);
}

CellIndex OpenedSuite::find(const std::string& wanted) {
  const std::vector<std::string> names = selection_names(cells_);
  const std::size_t methods = suite_.methods.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == wanted) return {i / methods, i % methods};
  }
  const bool may_be_key = wanted.find('/') == std::string::npos;
  for (std::size_t sequence = 0; may_be_key && sequence < sequences_.size(); ++sequence) {
    ScoredSequence scored = take_sequence(sequence);
    for (std::size_t method = 0; method < methods; ++method) {
      if (current_key(scored, suite_.methods[method]) == wanted) return {sequence, method};
    }
  }
  throw UsageError("--cell " + wanted +
                   ": this suite has no such cell. A key changes with parameters, data, "
                   "protocols and versions: see `raymoval plan`." +
                   suggestion(wanted, names));
}

void OpenedSuite::say(const std::string& line) const {
  if (options_.progress != nullptr) options_.progress->say(line);
}

JoinedFolder join_folder(OpenedSuite& suite) {
  const std::filesystem::path& out = suite.options().out;
  const RunRecord asked =
      run_record(suite.suite(), suite.sequences(), suite.threads(), suite.options().jobs);
  if (suite.options().overwrite) return {asked, {}};
  const std::optional<RunRecord> present = present_record(out);
  if (!present) return {asked, {}};
  refuse_other_results(out, why_not_together(*present, asked));
  for (std::size_t i = 0; i < suite.sequences().size(); ++i) check_same_data(suite, i, *present);
  JoinedFolder folder{merged_run_record(*present, asked), {}};
  if (!suite.is_alone()) folder.earlier = read_earlier_cells(suite.store(), folder.record, asked);
  return folder;
}

}  // namespace raymoval
