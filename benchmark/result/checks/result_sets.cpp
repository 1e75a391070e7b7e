// SPDX-License-Identifier: MIT
#include "benchmark/result/checks/result_sets.h"

#include <fmt/format.h>

#include "benchmark/result/checks/differences.h"
#include "benchmark/result/run_record_json.h"
#include "core/files/file_kind.h"

namespace raymoval {
namespace {

ComparedScore compared_score(const Score& score) {
  ComparedScore compared;
  compared.protocol = score.protocol.name;
  compared.identity = comparison_facts(score);
  compared.counts = score.counts;
  compared.rates = score.rates;
  return compared;
}

ComparedCell compared_cell(const Cell& cell) {
  ComparedCell compared;
  compared.sequence = cell.sequence;
  compared.name = cell.name;
  compared.control = cell.method.control;
  compared.status = status_name(cell.status);
  compared.reason = cell.reason;
  compared.method_version = cell.method.version;
  compared.identity = comparison_facts(cell);
  for (const Score& score : cell.scores) compared.scores.push_back(compared_score(score));
  if (cell.measured) {
    compared.seconds_per_scan = cell.measured->mean_seconds;
    compared.side_by_side = cell.measured->side_by_side.value_or(1);
  }
  return compared;
}

/// "AMD EPYC 7B13, 8 cores, 4 threads used"; empty if the file does not say it.
std::string machine_text(const std::optional<MachineRecord>& machine) {
  if (!machine) return "";
  return fmt::format(
      "{}, {} cores, {} threads used{}",
      machine->processor.empty() ? "an unknown processor" : machine->processor, machine->cores,
      machine->threads,
      machine->jobs ? fmt::format(" by each of {} cells at once", *machine->jobs) : "");
}

}  // namespace

std::filesystem::path find_results(const std::string& given) {
  const std::filesystem::path path(given);
  if (is_file(path) && path.extension() != ".json") {
    throw UsageError(given + ": expected a run folder, or its results.json.");
  }
  if (is_file(path)) return path;
  if (!is_folder(path)) {
    throw UsageError(given + ": no such run folder; expected what `raymoval run --out` made.");
  }
  const auto holds = [&](const char* name) { return is_there(path / name); };
  if (holds("results.json")) return path / "results.json";
  // A run that was stopped early may have cells only.
  if (holds("run.json") || holds("cells")) {
    throw UsageError(given +
                     ": has no results.json; the run did not reach its end. Start it again "
                     "with the same --out to go on.");
  }
  throw UsageError(
      given +
      ": is not a run folder (no run.json in it); expected what `raymoval run --out` made.");
}

ResultSet read_result_set(const std::filesystem::path& file) {
  const ResultsRecord results = read_results(file);
  ResultSet set;
  for (const Cell& cell : results.cells) set.cells.push_back(compared_cell(cell));
  set.control_problems = results.control_problems;
  set.machine = machine_text(results.run.machine);
  return set;
}

void write_reference(const std::filesystem::path& file, const std::filesystem::path& reference,
                     bool with_times) {
  ResultsRecord results = read_results(file);
  if (!results.control_problems.empty()) {
    throw UsageError(file.string() +
                     ": a run whose controls have wrong scores cannot be a reference (" +
                     results.control_problems.front() + ").");
  }
  bool timed = false;
  for (Cell& cell : results.cells) {
    if (!cell.ok()) {
      throw UsageError(file.string() + ": a run with failed cells cannot be a reference (" +
                       cell.title() + ": " + cell.reason + ").");
    }
    timed = timed || cell.measured;
    if (!with_times) cell.measured.reset();
    cell.output_tail.clear();
  }
  if (with_times && !timed) {
    throw UsageError(file.string() +
                     ": has no times that a reference could keep; leave --with-times out.");
  }
  results.run.build.reset();
  if (!with_times) results.run.machine.reset();
  write_results(reference, results);
}

}  // namespace raymoval
