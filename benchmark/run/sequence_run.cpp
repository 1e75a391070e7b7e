// SPDX-License-Identifier: MIT
#include "benchmark/run/sequence_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <utility>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/run/folder/run_folder.h"
#include "core/error.h"
#include "core/process/proc_files.h"
#include "core/terminal_colour.h"
#include "core/text.h"
#include "datasets/reading/left_out.h"

namespace raymoval {
namespace {

// A slower method is of no use. A short sequence has time for the start.
constexpr double kSecondsPerScan = 30.0;
constexpr double kLeastSeconds = 600.0;

/// @param jobs how many cells share the machine
ChildLimits limits_for(const Suite& suite, std::size_t scans, int jobs) {
  ChildLimits limits;
  limits.seconds = suite.time_limit_s > 0.0
                       ? suite.time_limit_s
                       : std::max(kLeastSeconds, kSecondsPerScan * static_cast<double>(scans));
  limits.memory_mib =
      suite.memory_limit_mib > 0.0 ? suite.memory_limit_mib : usual_memory_limit_mib() / jobs;
  return limits;
}

/// How the cells of a run are logged.
CellLines cell_lines(const OpenedSuite& suite) {
  std::vector<std::string> sequences, methods;
  for (const Sequence& sequence : suite.sequences()) sequences.push_back(sequence.name);
  for (const MethodRequest& request : suite.suite().methods) methods.push_back(request.name);
  return {sequences, methods, suite.cells().size()};
}

}  // namespace

void run_side_by_side(int jobs, std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> errors(count);
  const auto work_off = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();
        next = count;
      }
    }
  };
  {
    const std::size_t threads = std::min(static_cast<std::size_t>(std::max(jobs, 1)), count);
    std::vector<std::jthread> others;  // Joined at the end of the block.
    while (others.size() + 1 < threads) others.emplace_back(work_off);
    work_off();
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

SequenceRuns::SequenceRuns(OpenedSuite& suite, JoinedFolder& folder)
    : suite_(suite), folder_(folder), lines_(cell_lines(suite)), finished_(suite.cells().size()) {}

void SequenceRuns::run() {
  if (is_side_by_side()) return run_all_side_by_side();
  for (std::size_t i = 0; i < suite_.sequences().size(); ++i) run(i);
}

void SequenceRuns::run_all_side_by_side() {
  const std::size_t methods = suite_.suite().methods.size();
  std::vector<SharedSequence> shared(suite_.sequences().size());
  for (SharedSequence& one : shared) one.cells_left = methods;
  Progress* progress = suite_.options().progress;
  if (progress != nullptr) progress->begin("cells", finished_.size());
  run_side_by_side(suite_.options().jobs, finished_.size(), [&](std::size_t place) {
    const CellIndex index{place / methods, place % methods};
    run_job(shared[index.sequence], index);
    if (progress != nullptr) progress->advance();
  });
  if (progress != nullptr) progress->end();
}

void SequenceRuns::run_job(SharedSequence& shared, CellIndex index) {
  if (const std::shared_ptr<ScoredSequence> scored = open_shared(shared, index.sequence)) {
    run_cell(*scored, index);
  }
  const std::lock_guard lock(shared.mutex);
  if (--shared.cells_left == 0) shared.scored.reset();
}

std::shared_ptr<ScoredSequence> SequenceRuns::open_shared(SharedSequence& shared,
                                                          std::size_t sequence) {
  const std::lock_guard lock(shared.mutex);
  if (std::exchange(shared.is_opened, true) || !suite_.is_needed(sequence)) return shared.scored;
  auto scored = std::make_shared<ScoredSequence>(suite_.take_sequence(sequence));
  if (!read_data(*scored, sequence)) return nullptr;
  describe(sequence);
  shared.scored = std::move(scored);
  return shared.scored;
}

void SequenceRuns::run(std::size_t sequence) {
  if (!suite_.is_needed(sequence)) return;
  ScoredSequence scored = suite_.take_sequence(sequence);
  if (!read_data(scored, sequence)) return;
  describe(sequence);
  const std::size_t methods = suite_.suite().methods.size();
  for (std::size_t method = 0; method < methods; ++method) run_cell(scored, {sequence, method});
}

std::optional<PoseFitRecord> SequenceRuns::known_pose_fit(const std::string& sequence,
                                                          const std::string& fingerprint) {
  const std::lock_guard lock(mutex_);
  const SequenceRecord* known = find_named(folder_.record.sequences, sequence);
  if (known == nullptr || known->data.fingerprint != fingerprint) return std::nullopt;
  return known->pose_fit;
}

bool SequenceRuns::read_data(ScoredSequence& scored, std::size_t sequence) {
  std::string fingerprint;
  std::optional<PoseFitRecord> fit;
  try {
    fingerprint = scored.data_fingerprint();
    fit = known_pose_fit(scored.sequence().name, fingerprint);
    if (!fit) fit = scored.measure_pose_fit(suite_.options().cancel);
  } catch (const DataError& error) {
    {
      const std::lock_guard lock(mutex_);
      if (unreadable_++ == 0) first_unreadable_ = error.what();
    }
    fail_all(sequence, error.what());
    return false;
  }
  const std::string line = pose_fit_line(fit);
  if (!line.empty()) suite_.say(scored.sequence().name + ": " + line);
  const std::lock_guard lock(mutex_);
  const bool changed = set_reading(folder_.record, scored.sequence().name, fingerprint, fit);
  if (changed && !suite_.is_alone()) {
    write_run_record(suite_.options().out / "run.json", folder_.record);
  }
  return true;
}

void SequenceRuns::fail_all(std::size_t sequence, const std::string& reason) {
  for (std::size_t method = 0; method < suite_.suite().methods.size(); ++method) {
    const CellIndex index{sequence, method};
    if (!suite_.is_selected(index)) continue;
    const CellName& name = suite_.name(index);
    Cell cell = unreadable_cell(name.sequence, suite_.method(index), reason);
    if (suite_.store().has_result(name)) {
      suite_.say(name.title() + ": its stored result stays as it is.");
    } else if (may_run(index)) {
      suite_.store().keep(cell);
    }
    finish(index, std::move(cell), false);
  }
}

/// Logs facts about the data: how it was opened, lost scans, an estimated sensor for the methods'
/// bins, an up direction other than z, and points that no method sees.
void SequenceRuns::describe(std::size_t number) {
  const Sequence& sequence = suite_.sequences()[number];
  for (const std::string& line : opening_lines(sequence)) suite_.say(sequence.name + ": " + line);
  {
    const std::lock_guard lock(mutex_);
    for (const std::string& line : lost_scan_lines(sequence)) {
      summary_.lost_scans.push_back(sequence.name + ": " + line);
    }
  }
  const SensorModel& sensor = sequence.scans->sensor();
  if (sensor.is_estimated()) suite_.say(sequence.name + ": sensor estimated: " + sensor.basis);
  const std::string turned = up_line(sequence.up());
  if (!turned.empty()) suite_.say(sequence.name + ": " + turned);
  for (const std::string& line : left_out_lines(sequence)) suite_.say(sequence.name + ": " + line);
  const std::string empty = empty_scans_line(sequence);
  if (!empty.empty()) suite_.say(sequence.name + ": " + empty);
}

bool SequenceRuns::may_run(CellIndex index) const {
  return suite_.is_selected(index) && !suite_.options().collect;
}

MethodTask SequenceRuns::task_for(ScoredSequence& scored, CellIndex index) const {
  const RunOptions& options = suite_.options();
  MethodTask task{&scored.sequence(), &suite_.method(index)};
  task.options.threads = scored.threads();
  task.options.with_reasons = options.keep_removals;
  task.options.with_confidence = options.confidence;
  task.progress = scored.progress();
  task.cancel = options.cancel;
  if (options.isolate) {
    task.place = &suite_.suite().sequences[index.sequence];
    task.limits = limits_for(suite_.suite(), scored.sequence().scans->size(), options.jobs);
  }
  return task;
}

void SequenceRuns::run_cell(ScoredSequence& scored, CellIndex index) {
  throw_if_cancelled(suite_.options().cancel);
  if (suite_.is_alone() && !suite_.is_selected(index)) return;
  const MethodRequest& method = suite_.method(index);
  StoredCell stored = suite_.stored_cell(scored, index);
  const bool to_run = may_run(index);
  if (stored.state == StoredCell::State::kFresh ||
      (!to_run && stored.state == StoredCell::State::kFailed)) {
    finish(index, std::move(*stored.cell), true);
  } else if (to_run) {
    check_run_folder_stays(suite_.options().out);
    suite_.store().prepare(suite_.name(index));
    if (stored.state == StoredCell::State::kStale) {
      suite_.say(fmt::format("{} on {} is run again: {}", method.name, scored.sequence().name,
                             stored.why));
    }
    show_running(index);
    std::filesystem::path removals;
    if (suite_.options().keep_removals) removals = suite_.store().new_removals(suite_.name(index));
    Cell cell = execute_cell(scored, task_for(scored, index), removals);
    mark_times(cell.measured);
    check_run_folder_stays(suite_.options().out);
    suite_.store().keep(cell, removals);
    finish(index, std::move(cell), false);
  }
}

/// Shows a running cell on the live line.
void SequenceRuns::show_running(CellIndex index) {
  Progress* progress = suite_.options().progress;
  if (progress == nullptr) return;
  const CellName& cell = suite_.name(index);
  const std::lock_guard lock(mutex_);
  if (is_side_by_side()) {
    running_.insert(cell.title());
    return progress->set_context(join({running_.begin(), running_.end()}));
  }
  progress->set_context(fmt::format("[{}/{}] {} on {}", summary_.cells + 1, finished_.size(),
                                    cell.name, cell.sequence));
}

/// Removes finished cells from the shared live line. The caller holds the lock.
void SequenceRuns::show_stopped(CellIndex index) {
  Progress* progress = suite_.options().progress;
  if (progress == nullptr || !is_side_by_side()) return;
  running_.erase(suite_.name(index).title());
  progress->set_context(join({running_.begin(), running_.end()}));
}

void SequenceRuns::finish(CellIndex index, Cell cell, bool was_there) {
  const std::lock_guard lock(mutex_);
  ++summary_.cells;
  if (was_there) ++summary_.reused;
  std::string line = lines_.line(summary_.cells, cell, was_there);
  if (!cell.ok()) {
    line = in_red(line, stderr);
    summary_.failures.push_back(cell.title() + ": " + cell.reason);
  }
  finished_[suite_.place(index)] = std::move(cell);
  Progress* progress = suite_.options().progress;
  if (progress == nullptr) return;
  show_stopped(index);
  if (!is_side_by_side()) {
    progress->end();
    progress->set_context("");
  }
  suite_.say(line);
}

void SequenceRuns::mark_times(std::optional<Measurement>& measured) const {
  if (measured && is_side_by_side()) measured->side_by_side = suite_.options().jobs;
}

void SequenceRuns::check_any_readable() const {
  if (unreadable_ == suite_.sequences().size()) throw DataError(first_unreadable_);
}

}  // namespace raymoval
