// SPDX-License-Identifier: MIT
#include "benchmark/run/runner.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "benchmark/cli/terminal_colour.h"
#include "benchmark/process/checked_sink.h"
#include "benchmark/result/cell.h"
#include "benchmark/result/controls_check.h"
#include "benchmark/result/flat_sweeps.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/run/cell_store.h"
#include "benchmark/run/folder_content.h"
#include "benchmark/run/folder_lock.h"
#include "benchmark/run/run_folder.h"
#include "benchmark/run/sequence_bench.h"
#include "benchmark/tables/cell_line.h"
#include "core/files/file_kind.h"
#include "core/parallel.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;
using std::filesystem::path;

// A method that needs more than this for a scan is no use; a short sequence gets time to start.
constexpr double kSecondsPerScan = 30.0;
constexpr double kLeastSeconds = 600.0;

/// The sequences' names. Scenes are not generated for it: what is wrong with names shows before.
std::vector<std::string> sequence_names(const Suite& suite) {
  std::vector<std::string> names;
  for (const SequenceRequest& request : suite.sequences) {
    names.push_back(sequence_name(request.path, request.options));
    for (std::size_t i = 0; i + 1 < names.size(); ++i) {
      if (folder_name(names[i]) == folder_name(names.back())) {
        throw UsageError("two sequences of this run are called '" + names.back() + "' (" +
                         suite.sequences[i].path + " and " + request.path +
                         "). Run them into two folders, the second with --name NAME, or give each "
                         "a \"name\" in a suite file.");
      }
    }
  }
  return names;
}

std::vector<std::string> cell_names(const Suite& suite) {
  std::vector<std::string> names;
  for (const std::string& sequence : sequence_names(suite)) {
    for (const MethodRequest& request : suite.methods) {
      names.push_back(sequence + "/" + request.name);
    }
  }
  return names;
}

std::vector<Sequence> open_sequences(const Suite& suite, const OpenContext& context) {
  std::vector<Sequence> sequences;
  for (const SequenceRequest& request : suite.sequences) {
    sequences.push_back(open_sequence(request.path, request.options, context));
    check_has_labels(sequences.back());
  }
  return sequences;
}

ChildLimits limits_for(const Suite& suite, std::size_t scans) {
  ChildLimits limits;
  limits.seconds = suite.time_limit_s > 0.0
                       ? suite.time_limit_s
                       : std::max(kLeastSeconds, kSecondsPerScan * static_cast<double>(scans));
  limits.memory_mib =
      suite.memory_limit_mib > 0.0 ? suite.memory_limit_mib : usual_memory_limit_mib();
  return limits;
}

/// How the cells of a run are logged.
CellLines cell_lines(const Suite& suite, const std::vector<Sequence>& sequences) {
  std::vector<std::string> names, methods;
  for (const Sequence& sequence : sequences) names.push_back(sequence.name);
  for (const MethodRequest& request : suite.methods) methods.push_back(request.name);
  return {names, methods, names.size() * methods.size()};
}

/// The cells of a suite, one after another.
class Runner {
 public:
  Runner(const Suite& suite, const RunOptions& options)
      : suite_(suite),
        options_(options),
        store_(options.out),
        threads_(suite.threads > 0 ? suite.threads : hardware_threads()) {
    for (const ProtocolRequest& request : suite_.protocols) {
      (void)make_protocol(request.protocol, request.options);  // Bad options show before the work.
    }
    const std::vector<std::string> names = cell_names(suite_);
    selected_ = select_cells(options_.selection, names);
    sequences_ = open_sequences(suite_, {threads_, options_.progress, options_.cancel});
    cells_.resize(names.size());
    benches_.resize(sequences_.size());
  }

  RunSummary run_all() {
    prepare_run_folder(options_.out);
    const FolderLock lock(options_.out / kLockFile, FolderLock::Mode::kExclusive);
    sweep_run_folder(options_.out);
    join_folder();
    store_.sweep();
    write_sealed(options_.out / "run.json", record_);
    summary_.earlier = earlier_.kept.size();
    for (const std::string& line : earlier_.lines()) say(line);
    for (std::size_t i = 0; i < sequences_.size(); ++i) run_sequence(i);
    if (unreadable_ == sequences_.size()) throw DataError(first_unreadable_);
    finish();
    return summary_;
  }

  RunSummary run_one(const std::string& wanted) {
    const auto [sequence, method] = find_cell(wanted);
    const path folder = folder_of(sequence, method);
    prepare_run_folder(options_.out);
    const FolderLock run_lock(options_.out / kLockFile, FolderLock::Mode::kShared);
    alone_ = true;
    selected_.assign(selected_.size(), false);
    selected_[sequence * suite_.methods.size() + method] = true;
    join_folder();
    make_folder(folder);
    const FolderLock cell_lock(folder / kLockFile, FolderLock::Mode::kExclusive);
    run_sequence(sequence);
    return summary_;
  }

  SuitePlan plan() {
    SuitePlan plan;
    if (!options_.out.empty()) {
      try {
        join_folder();
      } catch (const UsageError& error) {
        plan.refused = error.what();
      }
    }
    for (std::size_t i = 0; i < sequences_.size(); ++i) plan_sequence(i, plan.cells);
    for (const EarlierCells::Kept& kept : earlier_.kept) plan.earlier.push_back(kept.cell);
    plan.left_out = earlier_.left_out;
    return plan;
  }

 private:
  [[nodiscard]] path folder_of(std::size_t sequence, std::size_t method) const {
    return store_.folder(sequences_[sequence].name, suite_.methods[method]);
  }
  [[nodiscard]] bool is_selected(std::size_t sequence, std::size_t method) const {
    return selected_[sequence * suite_.methods.size() + method];
  }
  [[nodiscard]] ordered_json& cell_at(std::size_t sequence, std::size_t method) {
    return cells_[sequence * suite_.methods.size() + method];
  }
  /// The bench that `join_folder` made, which knows its fingerprint already, or a new one.
  [[nodiscard]] SequenceBench bench_of(std::size_t sequence) {
    if (auto& made = benches_[sequence]) {
      SequenceBench bench = std::move(*made);
      made.reset();
      return bench;
    }
    return {sequences_[sequence], suite_.protocols, threads_, options_.progress};
  }

  /// Makes sure that this run and what the folder holds belong together, and reads the cells of
  /// earlier runs. @throws UsageError if they do not; DataError
  void join_folder() {
    const ordered_json asked = run_record(suite_, sequences_, threads_);
    record_ = asked;
    const ordered_json present =
        options_.overwrite ? ordered_json() : read_run_record(options_.out);
    if (present.is_null()) return;
    refuse_other_results(options_.out, why_not_together(present, asked));
    for (std::size_t i = 0; i < sequences_.size(); ++i) check_same_data(i, present);
    record_ = merged_run_record(present, asked);
    if (!alone_) earlier_ = read_earlier_cells(store_, record_, asked);
  }

  void check_same_data(std::size_t sequence, const ordered_json& present) {
    const std::string& name = sequences_[sequence].name;
    if (known_fingerprint(present, name).empty() || !is_needed(sequence)) return;
    SequenceBench bench = bench_of(sequence);
    try {
      (void)bench.data_fingerprint();
    } catch (const DataError&) {
      return;  // Its cells will tell.
    }
    refuse_other_results(options_.out, why_other_data(present, name, bench.data_fingerprint()));
    benches_[sequence].emplace(std::move(bench));
  }

  /// Whether anything of a sequence is to be run or may be there: else its data is not read.
  [[nodiscard]] bool is_needed(std::size_t sequence) const {
    for (std::size_t method = 0; method < suite_.methods.size(); ++method) {
      if (is_selected(sequence, method)) return true;
      if (!alone_ && has_file(folder_of(sequence, method) / "cell.json")) {
        return true;
      }
    }
    return false;
  }

  void run_sequence(std::size_t sequence) {
    if (!is_needed(sequence)) return;
    SequenceBench bench = bench_of(sequence);
    try {
      if (note_fingerprint(record_, bench.sequence().name, bench.data_fingerprint()) && !alone_) {
        write_sealed(options_.out / "run.json", record_);
      }
    } catch (const DataError& error) {
      if (unreadable_++ == 0) first_unreadable_ = error.what();
      for (std::size_t method = 0; method < suite_.methods.size(); ++method) {
        if (!is_selected(sequence, method)) continue;
        keep(sequence, method,
             unreadable_cell(bench.sequence().name, suite_.methods[method], error.what()));
      }
      return;
    }
    tell_sensor(bench.sequence());
    const std::string turned = up_line(bench.sequence().up());
    if (options_.progress != nullptr && !turned.empty()) {
      options_.progress->say(bench.sequence().name + ": " + turned);
    }
    tell_left_out(sequence);
    for (std::size_t method = 0; method < suite_.methods.size(); ++method) {
      run_cell(bench, sequence, method);
    }
    // Method after method in each round, so that a machine that slows down slows all of them.
    for (int round = 2; round <= suite_.repeats; ++round) {
      for (std::size_t method = 0; method < suite_.methods.size(); ++method) {
        repeat(bench, sequence, method, round);
      }
    }
  }

  /// Says what an estimated sensor rests on: methods take their bins from it.
  void tell_sensor(const Sequence& sequence) const {
    const SensorModel& sensor = sequence.scans->sensor();
    if (options_.progress == nullptr || !sensor.is_estimated()) return;
    options_.progress->say(sequence.name + ": sensor estimated: " + sensor.basis);
  }

  [[nodiscard]] CellTask task_for(SequenceBench& bench, std::size_t sequence,
                                  std::size_t method) const {
    CellTask task{&bench, &suite_.methods[method], {}, options_.cancel, nullptr, {}};
    if (options_.keep_removals) task.removals = store_.new_removals(folder_of(sequence, method));
    if (options_.isolate) {
      task.place = &suite_.sequences[sequence];
      task.limits = limits_for(suite_, bench.sequence().scans->size());
    }
    return task;
  }

  void run_cell(SequenceBench& bench, std::size_t sequence, std::size_t method) {
    if (options_.cancel != nullptr && options_.cancel->load()) throw Cancelled();
    if (alone_ && !is_selected(sequence, method)) return;
    StoredCell stored = store_.find(bench, suite_.methods[method], options_.keep_removals);
    const bool selected = is_selected(sequence, method);
    const bool may_fail = options_.collect || !selected;
    if (stored.state == StoredCell::State::kFresh ||
        (may_fail && stored.state == StoredCell::State::kFailed)) {
      ++summary_.reused;
      keep_in_memory(sequence, method, std::move(*stored.cell), true);
    } else if (selected && !options_.collect) {
      store_.prepare(folder_of(sequence, method));
      if (stored.state == StoredCell::State::kStale) {
        say(suite_.methods[method].name + " on " + bench.sequence().name +
            " is run again: " + stored.why);
      }
      tell_cell(sequence, method, "");
      const CellTask task = task_for(bench, sequence, method);
      keep(sequence, method, execute_cell(task), task.removals);
    }
  }

  void say(const std::string& line) const {
    if (options_.progress != nullptr) options_.progress->say(line);
  }

  /// Which points no method sees, once a sequence.
  void tell_left_out(std::size_t sequence) const {
    if (options_.progress == nullptr) return;
    for (const std::string& line : left_out_lines(sequences_[sequence])) {
      options_.progress->say(sequences_[sequence].name + ": " + line);
    }
  }

  /// What the live line is about.
  void tell_cell(std::size_t sequence, std::size_t method, const std::string& round) const {
    if (options_.progress == nullptr) return;
    options_.progress->set_context("[" + std::to_string(summary_.cells + (round.empty() ? 1 : 0)) +
                                   "/" + std::to_string(cells_.size()) + "] " +
                                   suite_.methods[method].name + " on " +
                                   sequences_[sequence].name + round);
  }

  void repeat(SequenceBench& bench, std::size_t sequence, std::size_t method, int round) {
    const MethodRequest& request = suite_.methods[method];
    ordered_json& cell = cell_at(sequence, method);
    if (cell.is_null() || cell["status"] != "ok" || is_control(request.method.entry->name)) return;
    const std::string& name = bench.sequence().name;
    const auto key = cell["key"].get<std::string>();
    auto stored = store_.find_repeat(name, request.name, round, key);
    if (!stored && is_selected(sequence, method) && !options_.collect) {
      if (options_.cancel != nullptr && options_.cancel->load()) throw Cancelled();
      tell_cell(sequence, method, ", repeat " + std::to_string(round));
      const MethodAnswer answer = repeat_cell(task_for(bench, sequence, method));
      if (answer.status != "ok") {
        return fail_repeat(sequence, method, round, answer.status, answer.reason);
      }
      stored = StoredRepeat{mask_digest(answer.masks), answer.measured};
      store_.keep_repeat(folder_of(sequence, method), round, key, *stored);
    }
    if (!stored) return;
    if (stored->digest != cell["masks"]["digest"]) {
      return fail_repeat(sequence, method, round, "failed",
                         "it removed other points than before, and must always remove the same");
    }
    repeats_[&cell].push_back(stored->measured);
  }

  void fail_repeat(std::size_t sequence, std::size_t method, int round, const std::string& status,
                   const std::string& reason) {
    ordered_json& cell = cell_at(sequence, method);
    cell["status"] = status;
    cell["reason"] = "repeat " + std::to_string(round) + ": " + reason;
    cell["protocols"] = ordered_json::array();
    store_.keep(folder_of(sequence, method), cell);
    summary_.failures.push_back(failure_text(cell));
  }

  void keep(std::size_t sequence, std::size_t method, ordered_json cell,
            const path& removals = {}) {
    const path folder = folder_of(sequence, method);
    make_folder(folder);
    store_.keep(folder, cell, removals);
    keep_in_memory(sequence, method, std::move(cell), false);
  }

  static std::string failure_text(const ordered_json& cell) {
    return cell["sequence"].get<std::string>() + " / " + cell["name"].get<std::string>() + ": " +
           cell["reason"].get<std::string>();
  }

  void keep_in_memory(std::size_t sequence, std::size_t method, ordered_json cell, bool kept) {
    ++summary_.cells;
    std::string line = cell_lines(suite_, sequences_).line(summary_.cells, cell, kept);
    if (cell["status"] != "ok") {
      line = coloured(line, TerminalColour::kBad, stderr);
      summary_.failures.push_back(failure_text(cell));
    }
    cell_at(sequence, method) = std::move(cell);
    if (options_.progress == nullptr) return;
    options_.progress->end();
    options_.progress->set_context("");
    options_.progress->say(line);
  }

  /// Writes results and tables of all cells that belong to the folder and are there.
  void finish() {
    std::vector<ordered_json> there;
    std::vector<std::string> missing;
    for (const FolderCell& cell : folder_cells(record_)) {
      const std::optional<std::size_t> asked = index_of(cell);
      const ordered_json* found = asked ? &cells_[*asked] : earlier_.find(cell);
      if (found != nullptr && !found->is_null()) {
        there.push_back(*found);
        const auto repeats = repeats_.find(found);
        if (repeats != repeats_.end()) merge_repeats(there.back(), repeats->second);
        continue;
      }
      missing.push_back(cell.sequence + " / " + cell.name);
      if (asked) summary_.missing.push_back(missing.back());
    }
    const bool controls = record_["suite"]["controls"].get<bool>();
    if (controls) summary_.controls = check_controls(there);
    const RunResults results =
        write_results(options_.out, {&record_, &there, controls, summary_.controls, missing});
    summary_.flat_sweeps = flat_sweeps(results);
  }

  /// Place of a cell of the folder among those of the suite; nothing if the suite has no such cell.
  [[nodiscard]] std::optional<std::size_t> index_of(const FolderCell& cell) const {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (sequences_[i / suite_.methods.size()].name == cell.sequence &&
          suite_.methods[i % suite_.methods.size()].name == cell.name) {
        return i;
      }
    }
    return std::nullopt;
  }

  void plan_sequence(std::size_t sequence, std::vector<PlannedCell>& planned) {
    SequenceBench bench = bench_of(sequence);
    std::string unreadable;
    try {
      (void)bench.data_fingerprint();
    } catch (const DataError& error) {
      unreadable = error.what();
    }
    for (std::size_t method = 0; method < suite_.methods.size(); ++method) {
      const MethodRequest& request = suite_.methods[method];
      PlannedCell cell;
      cell.sequence = bench.sequence().name;
      cell.name = request.name;
      cell.method = request.method.full_name();
      cell.folder = CellStore("").folder(cell.sequence, request);
      cell.scans = bench.sequence().scans->size();
      cell.why = "is not there yet";
      if (!unreadable.empty()) {
        cell.why = "its data cannot be read: " + unreadable;
      } else {
        cell.key = cell_key(bench, request);
        if (!options_.out.empty()) judge(bench, request, cell);
      }
      if (!is_selected(sequence, method)) {
        cell.to_run = false;
        cell.why = "is not selected";
      }
      planned.push_back(std::move(cell));
    }
  }

  void judge(SequenceBench& bench, const MethodRequest& request, PlannedCell& cell) const {
    const StoredCell stored = store_.find(bench, request, options_.keep_removals);
    cell.why = stored.why;
    cell.to_run = stored.state != StoredCell::State::kFresh;
    for (int round = 2; round <= suite_.repeats && !cell.to_run; ++round) {
      if (is_control(request.method.entry->name)) break;
      if (store_.find_repeat(cell.sequence, request.name, round, cell.key)) continue;
      cell.to_run = true;
      cell.why = "repeat " + std::to_string(round) + " is not there yet";
    }
  }

  /// By "SEQUENCE/NAME" without reading data, else by key.
  [[nodiscard]] std::pair<std::size_t, std::size_t> find_cell(const std::string& wanted) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const std::size_t sequence = i / suite_.methods.size(), method = i % suite_.methods.size();
      names.push_back(sequences_[sequence].name + "/" + suite_.methods[method].name);
      if (names.back() == wanted) return {sequence, method};
    }
    if (wanted.find('/') == std::string::npos) {
      for (std::size_t sequence = 0; sequence < sequences_.size(); ++sequence) {
        SequenceBench bench = bench_of(sequence);
        for (std::size_t method = 0; method < suite_.methods.size(); ++method) {
          if (cell_key(bench, suite_.methods[method]) == wanted) return {sequence, method};
        }
      }
    }
    throw UsageError("--cell " + wanted +
                     ": this suite has no such cell. A key changes with parameters, data, "
                     "protocols and versions: see `raymoval plan`." +
                     suggestion(wanted, names));
  }

  const Suite& suite_;
  const RunOptions& options_;
  CellStore store_;
  int threads_;
  std::vector<Sequence> sequences_;
  std::vector<bool> selected_;                         ///< By sequence, then method.
  std::vector<ordered_json> cells_;                    ///< The same; null: not there.
  std::vector<std::optional<SequenceBench>> benches_;  ///< By sequence, see `bench_of`.
  ordered_json record_;                                ///< What run.json says.
  EarlierCells earlier_;
  std::map<const ordered_json*, std::vector<Measurement>> repeats_;
  RunSummary summary_;
  bool alone_ = false;  ///< One cell only: the others are not looked at.
  std::size_t unreadable_ = 0;
  std::string first_unreadable_;
};

}  // namespace

RunSummary run_suite(const Suite& suite, const RunOptions& options) {
  return Runner(suite, options).run_all();
}

RunSummary run_one_cell(const Suite& suite, const RunOptions& options, const std::string& cell) {
  return Runner(suite, options).run_one(cell);
}

SuitePlan plan_suite(const Suite& suite, const RunOptions& options) {
  return Runner(suite, options).plan();
}

}  // namespace raymoval
