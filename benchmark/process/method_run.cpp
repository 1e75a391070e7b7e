// SPDX-License-Identifier: MIT
#include "benchmark/process/method_run.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <nlohmann/json.hpp>
#include <numeric>

#include "benchmark/process/checked_sink.h"
#include "benchmark/process/machine.h"
#include "core/scan/local_frame.h"
#include "methods/controls/controls.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

/// Value below which `share` of the sorted values lie (nearest rank); nothing without values.
std::optional<double> quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return std::nullopt;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

/// Mean of the values from `first` on, `count` of them.
double mean_from(const std::vector<double>& values, std::size_t first, std::size_t count) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0.0) /
         static_cast<double>(count);
}

/// The first scans are left out: there is no map yet, and memory is new.
void measure_growth(const std::vector<double>& by_scan, Measurement& measured) {
  constexpr std::size_t kFewest = 300, kFirst = 50, kCount = 100;
  if (by_scan.size() < kFewest) return;
  measured.early_seconds = mean_from(by_scan, kFirst, kCount);
  measured.late_seconds = mean_from(by_scan, by_scan.size() - kCount, kCount);
}

/// Largest memory of this process since `reset_peak_memory`, or of one that the method started.
std::optional<double> peak_since_reset(bool was_reset) {
  const auto own = peak_memory_mib();
  if (!own || !was_reset) return std::nullopt;
  rusage children{};
  if (::getrusage(RUSAGE_CHILDREN, &children) != 0) return own;
  return std::max(*own, static_cast<double>(children.ru_maxrss) / 1024.0);
}

/// @param seconds wall time of the method without its waiting for scans
Measurement measure(const StageTimes& times, const TimedSource& scans, double seconds,
                    int threads) {
  std::vector<double> by_scan = times.seconds_by_scan();
  Measurement measured;
  measure_growth(by_scan, measured);
  std::sort(by_scan.begin(), by_scan.end());
  measured.threads = threads;
  measured.mean_seconds = seconds / static_cast<double>(scans.size());
  measured.median_seconds = quantile(by_scan, 0.5);
  measured.p90_seconds = quantile(by_scan, 0.9);
  measured.total_seconds = seconds;
  measured.load_seconds = scans.waited_seconds();
  for (const StageTimes::Stage& stage : times.stages()) {
    measured.stages.emplace_back(stage.name, stage.seconds);
  }
  return measured;
}

void answer_task(const MethodTask& task, MethodAnswer& answer) {
  const auto remover = make_remover(task.request->method, *task.sequence);
  // The one frame that methods see; masks go by index, so nothing has to be turned back.
  const LocalFrameSource local(*task.sequence->scans, task.sequence->method_frame());
  const TimedSource scans(local);
  CheckedSink sink(task.request->name, scans);
  StageTimes times;
  RunContext context;
  context.threads = task.threads;
  context.progress = task.progress;
  context.times = &times;
  context.cancel = task.cancel;
  ReasonStore reasons(task.request->name, scans);
  if (task.with_reasons) context.reasons = &reasons;
  const bool was_reset = reset_peak_memory();
  const auto started = std::chrono::steady_clock::now();
  remover->run(scans, sink, context);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
  const double seconds = std::max(0.0, wall.count() - scans.waited_seconds());
  answer.measured = measure(times, scans, seconds, task.threads);
  answer.measured.peak_memory_mib = peak_since_reset(was_reset);
  answer.masks = sink.finish();
  answer.reasons = reasons.finish();
}

ordered_json number_or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : nullptr;
}

std::optional<double> number_or_nothing(const ordered_json& json) {
  if (json.is_null()) return std::nullopt;
  return json.get<double>();
}

}  // namespace

ordered_json to_json(const Measurement& measured) {
  ordered_json record;
  record["threads"] = measured.threads;
  record["seconds_per_scan"]["mean"] = measured.mean_seconds;
  record["seconds_per_scan"]["median"] = number_or_null(measured.median_seconds);
  record["seconds_per_scan"]["p90"] = number_or_null(measured.p90_seconds);
  record["seconds_per_scan"]["early"] = number_or_null(measured.early_seconds);
  record["seconds_per_scan"]["late"] = number_or_null(measured.late_seconds);
  record["seconds_total"] = measured.total_seconds;
  record["seconds_load"] = measured.load_seconds;
  record["stages"] = ordered_json::array();
  for (const auto& [name, seconds] : measured.stages) {
    record["stages"].push_back({{"name", name}, {"seconds", seconds}});
  }
  record["peak_memory_mib"] = number_or_null(measured.peak_memory_mib);
  return record;
}

Measurement measurement_from(const ordered_json& json) {
  Measurement measured;
  measured.threads = json.at("threads").get<int>();
  const ordered_json& by_scan = json.at("seconds_per_scan");
  measured.mean_seconds = by_scan.at("mean").get<double>();
  measured.median_seconds = number_or_nothing(by_scan.at("median"));
  measured.p90_seconds = number_or_nothing(by_scan.at("p90"));
  // Not in files of earlier versions.
  measured.early_seconds = number_or_nothing(by_scan.value("early", ordered_json()));
  measured.late_seconds = number_or_nothing(by_scan.value("late", ordered_json()));
  measured.total_seconds = json.at("seconds_total").get<double>();
  measured.load_seconds = json.at("seconds_load").get<double>();
  for (const ordered_json& stage : json.at("stages")) {
    measured.stages.emplace_back(stage.at("name").get<std::string>(),
                                 stage.at("seconds").get<double>());
  }
  measured.peak_memory_mib = number_or_nothing(json.at("peak_memory_mib"));
  return measured;
}

MethodAnswer run_method(const MethodTask& task) {
  MethodAnswer answer;
  const auto fail = [&](const char* status, const std::string& reason) {
    answer = {};
    answer.status = status;
    answer.reason = reason;
  };
  try {
    answer_task(task, answer);
  } catch (const Cancelled&) {
    throw;
  } catch (const DataError& error) {
    fail("bad_data", error.what());
  } catch (const std::bad_alloc&) {
    fail("out_of_memory", "there was not enough memory");
  } catch (const std::exception& error) {
    fail("failed", error.what());
  } catch (...) {
    fail("failed", "the method threw something that is no std::exception");
  }
  return answer;
}

void check_has_labels(const Sequence& sequence) {
  if (sequence.labels != nullptr) return;
  throw DataError("sequence '" + sequence.name +
                  "' has no labels, so nothing can be scored on it; expected a folder labels/ "
                  "beside the scans. To clean a map without labels use `raymoval clean`.");
}

std::unique_ptr<Remover> make_remover(const ConfiguredMethod& method, const Sequence& sequence) {
  if (!method.entry->needs_truth) return method.make();
  check_has_labels(sequence);
  return make_replay([labels = sequence.labels, rule = sequence.label_rule](const Scan& scan) {
    const std::vector<std::uint32_t> words = labels->labels(scan);
    Mask mask(words.size());
    std::transform(words.begin(), words.end(), mask.begin(), [&](std::uint32_t word) {
      return static_cast<std::uint8_t>(rule.classify(word) == LabelClass::kMoving);
    });
    return mask;
  });
}

}  // namespace raymoval
