// SPDX-License-Identifier: MIT
#include "benchmark/run/sequence_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/run_record_json.h"
#include "core/process/proc_files.h"
#include "core/terminal_colour.h"
#include "datasets/reading/left_out.h"

namespace raymoval {
namespace {

// A method that needs more than this for a scan is no use; a short sequence gets time to start.
constexpr double kSecondsPerScan = 30.0;
constexpr double kLeastSeconds = 600.0;

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
CellLines cell_lines(const OpenedSuite& suite) {
  std::vector<std::string> sequences, methods;
  for (const Sequence& sequence : suite.sequences()) sequences.push_back(sequence.name);
  for (const MethodRequest& request : suite.suite().methods) methods.push_back(request.name);
  return {sequences, methods, suite.cells().size()};
}

void check_cancelled(const RunOptions& options) {
  if (options.cancel != nullptr && options.cancel->load()) throw Cancelled();
}

}  // namespace

SequenceRuns::SequenceRuns(OpenedSuite& suite, JoinedFolder& folder)
    : suite_(suite), folder_(folder), lines_(cell_lines(suite)), finished_(suite.cells().size()) {}

void SequenceRuns::run(std::size_t sequence) {
  if (!suite_.is_needed(sequence)) return;
  ScoredSequence scored = suite_.take_sequence(sequence);
  if (!read_data(scored, sequence)) return;
  describe(sequence);
  const std::size_t methods = suite_.suite().methods.size();
  for (std::size_t method = 0; method < methods; ++method) run_cell(scored, {sequence, method});
  // Method after method in each round, so that a machine that slows down slows all of them.
  for (int round = 2; round <= suite_.suite().repeats; ++round) {
    for (std::size_t method = 0; method < methods; ++method) {
      repeat(scored, {sequence, method}, round);
    }
  }
}

bool SequenceRuns::read_data(ScoredSequence& scored, std::size_t sequence) {
  try {
    const bool changed =
        set_fingerprint(folder_.record, scored.sequence().name, scored.data_fingerprint());
    if (changed && !suite_.is_alone()) {
      write_run_record(suite_.options().out / "run.json", folder_.record);
    }
    return true;
  } catch (const DataError& error) {
    if (unreadable_++ == 0) first_unreadable_ = error.what();
    fail_all(sequence, error.what());
    return false;
  }
}

void SequenceRuns::fail_all(std::size_t sequence, const std::string& reason) {
  for (std::size_t method = 0; method < suite_.suite().methods.size(); ++method) {
    const CellIndex index{sequence, method};
    if (!suite_.is_selected(index)) continue;
    Cell cell = unreadable_cell(suite_.name(index).sequence, suite_.method(index), reason);
    suite_.store().keep(cell);
    finish(index, std::move(cell), false);
  }
}

/// Says what a reader has to know of the data: methods take their bins from an estimated sensor, up
/// is not z, and which points no method sees.
void SequenceRuns::describe(std::size_t number) const {
  const Sequence& sequence = suite_.sequences()[number];
  const SensorModel& sensor = sequence.scans->sensor();
  if (sensor.is_estimated()) suite_.say(sequence.name + ": sensor estimated: " + sensor.basis);
  const std::string turned = up_line(sequence.up());
  if (!turned.empty()) suite_.say(sequence.name + ": " + turned);
  for (const std::string& line : left_out_lines(sequence)) suite_.say(sequence.name + ": " + line);
}

CellTask SequenceRuns::task_for(ScoredSequence& scored, CellIndex index) const {
  const RunOptions& options = suite_.options();
  CellTask task{&scored, &suite_.method(index), {}, options.cancel, nullptr, {}};
  if (options.keep_removals) task.removals = suite_.store().new_removals(suite_.name(index));
  if (options.isolate) {
    task.place = &suite_.suite().sequences[index.sequence];
    task.limits = limits_for(suite_.suite(), scored.sequence().scans->size());
  }
  return task;
}

void SequenceRuns::run_cell(ScoredSequence& scored, CellIndex index) {
  check_cancelled(suite_.options());
  const bool selected = suite_.is_selected(index);
  if (suite_.is_alone() && !selected) return;
  const MethodRequest& method = suite_.method(index);
  StoredCell stored = suite_.stored_cell(scored, index);
  const bool to_run = selected && !suite_.options().collect;
  if (stored.state == StoredCell::State::kFresh ||
      (!to_run && stored.state == StoredCell::State::kFailed)) {
    ++summary_.reused;
    finish(index, std::move(*stored.cell), true);
  } else if (to_run) {
    suite_.store().prepare(suite_.name(index));
    if (stored.state == StoredCell::State::kStale) {
      suite_.say(fmt::format("{} on {} is run again: {}", method.name, scored.sequence().name,
                             stored.why));
    }
    show_running(index, "");
    const CellTask task = task_for(scored, index);
    Cell cell = execute_cell(task);
    suite_.store().keep(cell, task.removals);
    finish(index, std::move(cell), false);
  }
}

void SequenceRuns::repeat(ScoredSequence& scored, CellIndex index, int round) {
  FinishedCell& finished = finished_[suite_.place(index)];
  const bool has_result = finished.cell && finished.cell->ok() && finished.cell->masks;
  if (!has_result || finished.cell->method.control) return;
  auto repeat = suite_.store().find_repeat(suite_.name(index), round, finished.cell->key);
  if (!repeat && suite_.is_selected(index) && !suite_.options().collect) {
    repeat = run_again(scored, index, round);
  }
  if (!repeat) return;
  if (repeat->digest != finished.cell->masks->digest) {
    return fail_repeat(index, round, CellStatus::kFailed,
                       "it removed other points than before, and must always remove the same");
  }
  finished.repeats.push_back(repeat->measured);
}

std::optional<RepeatRecord> SequenceRuns::run_again(ScoredSequence& scored, CellIndex index,
                                                    int round) {
  check_cancelled(suite_.options());
  show_running(index, fmt::format(", repeat {}", round));
  const MethodAnswer answer = repeat_cell(task_for(scored, index));
  if (answer.status != CellStatus::kOk) {
    fail_repeat(index, round, answer.status, answer.reason);
    return std::nullopt;
  }
  const std::string& key = finished_[suite_.place(index)].cell->key;
  const RepeatRecord repeat{key, round, mask_digest(answer.masks), answer.measured};
  suite_.store().keep_repeat(suite_.name(index), repeat);
  return repeat;
}

void SequenceRuns::fail_repeat(CellIndex index, int round, CellStatus status,
                               const std::string& reason) {
  Cell& cell = *finished_[suite_.place(index)].cell;
  cell.status = status;
  cell.reason = fmt::format("repeat {}: {}", round, reason);
  cell.scores.clear();
  suite_.store().keep(cell);
  summary_.failures.push_back(cell.title() + ": " + cell.reason);
}

/// Shows on the live line what is running.
void SequenceRuns::show_running(CellIndex index, const std::string& round) const {
  Progress* progress = suite_.options().progress;
  if (progress == nullptr) return;
  const CellName& cell = suite_.name(index);
  progress->set_context(fmt::format("[{}/{}] {} on {}{}", summary_.cells + (round.empty() ? 1 : 0),
                                    finished_.size(), cell.name, cell.sequence, round));
}

void SequenceRuns::finish(CellIndex index, Cell cell, bool was_there) {
  ++summary_.cells;
  std::string line = lines_.line(summary_.cells, cell, was_there);
  if (!cell.ok()) {
    line = coloured(line, TerminalColour::kBad, stderr);
    summary_.failures.push_back(cell.title() + ": " + cell.reason);
  }
  finished_[suite_.place(index)].cell = std::move(cell);
  if (suite_.options().progress == nullptr) return;
  suite_.options().progress->end();
  suite_.options().progress->set_context("");
  suite_.say(line);
}

void SequenceRuns::check_any_readable() const {
  if (unreadable_ == suite_.sequences().size()) throw DataError(first_unreadable_);
}

}  // namespace raymoval
