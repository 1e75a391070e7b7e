// SPDX-License-Identifier: MIT
#include "benchmark/kernels/cell_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "benchmark/kernels/yardstick.h"
#include "benchmark/process/machine.h"
#include "benchmark/run/cell_run.h"
#include "benchmark/run/scored_sequence.h"
#include "core/error.h"
#include "core/sampling.h"
#include "datasets/open_sequence.h"

namespace raymoval::kernels_bench {
namespace {

constexpr const char* kScene = "town:scans=30";

template <class Work>
double seconds_of(Work&& work) {
  const auto started = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
}

/// Seconds of a part of a cell, and of the yardstick beside it, in each round.
struct Times {
  std::vector<double> seconds, relative;

  void add(double part, double yardstick) {
    seconds.push_back(part);
    relative.push_back(part / yardstick);
  }
  [[nodiscard]] SpeedFigure figure() const {
    const auto [least, most] = std::minmax_element(relative.begin(), relative.end());
    return {1e3 * median(seconds), median(relative), *least, *most};
  }
};

struct CellTimes {
  Times whole, load, run, score;
};

ScoredSequence opened_scene() {
  Suite suite;
  add_protocol(suite, "erasor", "");
  add_protocol(suite, "dynamicmap", "");
  ScoredSequence scored(open_sequence(kScene, {}), suite.protocols, 1, nullptr);
  (void)scored.data_fingerprint();
  return scored;
}

/// @return the cell's wall time in seconds
double time_cell(ScoredSequence& scored, const MethodRequest& method, Cell& cell) {
  const MethodTask task{&scored.sequence(), &method};
  const double seconds = seconds_of([&] { cell = execute_cell(scored, task); });
  if (cell.ok() && cell.measured) return seconds;
  throw Error(method.name + " on " + kScene + ": " + cell.reason, ExitCode::kWorse);
}

void time_round(ScoredSequence& scored, const Suite& suite, std::vector<CellTimes>& times,
                Times& yardsticks) {
  for (std::size_t i = 0; i < suite.methods.size(); ++i) {
    std::uint64_t made = 0;
    const double yardstick = seconds_of([&] { made = run_yardstick(); });
    if (made == 0) throw InternalError("the yardstick has made nothing");
    yardsticks.add(yardstick, yardstick);
    Cell cell;
    const double whole = time_cell(scored, suite.methods[i], cell);
    const double load = cell.measured->load_seconds, run = cell.measured->total_seconds;
    times[i].whole.add(whole, yardstick);
    times[i].load.add(load, yardstick);
    times[i].run.add(run, yardstick);
    times[i].score.add(std::max(0.0, whole - load - run), yardstick);
  }
}

}  // namespace

SpeedRecord time_cells(int rounds) {
  const MethodRegistry registry = MethodRegistry::built_in();
  Suite suite;
  for (const std::string& name : expanded_methods("all", registry)) {
    add_method(suite, name, "", registry);
  }
  ScoredSequence scored = opened_scene();
  Cell first;
  (void)time_cell(scored, suite.methods.front(), first);  // Builds the data that all cells share.
  std::vector<CellTimes> times(suite.methods.size());
  Times yardsticks;
  for (int round = 1; round <= rounds; ++round) {
    std::fprintf(stderr, "kernels: whole cells, round %d of %d\n", round, rounds);
    time_round(scored, suite, times, yardsticks);
  }
  SpeedRecord speed{kScene, static_cast<int>(scored.sequence().scans->size()), 1, rounds};
  speed.yardstick = kYardstick;
  speed.yardstick_milliseconds = yardsticks.figure().milliseconds;
  speed.processor = machine_record(1).processor;
  speed.commit = build_record().commit;
  for (std::size_t i = 0; i < times.size(); ++i) {
    speed.cells.push_back({suite.methods[i].name, times[i].whole.figure(), times[i].load.figure(),
                           times[i].run.figure(), times[i].score.figure()});
  }
  return speed;
}

std::string cells_table(const SpeedRecord& speed) {
  std::string text = fmt::format(
      "\n## Whole cells\n\n{} ({} scans), {} thread, both protocols, median of {}. A yardstick is "
      "{:.1f} ms here.\n\n| method | yardsticks | min | max | ms | load, ms | method, ms | score, "
      "ms "
      "|\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
      speed.scene, speed.scans, speed.threads, speed.repetitions, speed.yardstick_milliseconds);
  for (const CellSpeed& cell : speed.cells) {
    text += fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} |\n",
                        cell.method, cell.whole.median, cell.whole.least, cell.whole.most,
                        cell.whole.milliseconds, cell.load.milliseconds, cell.run.milliseconds,
                        cell.score.milliseconds);
  }
  return text;
}

}  // namespace raymoval::kernels_bench
