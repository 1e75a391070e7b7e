// SPDX-License-Identifier: MIT
#include "benchmark/process/method_run.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>

#include "benchmark/process/checked_sink.h"
#include "benchmark/process/machine.h"
#include "benchmark/process/split_sensors.h"
#include "core/scan/local_frame.h"
#include "datasets/layouts.h"
#include "methods/controls/controls.h"

namespace raymoval {
namespace {

/// Value below which `share` of the sorted values lie (nearest rank); nothing without values.
std::optional<double> quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return std::nullopt;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
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
  std::sort(by_scan.begin(), by_scan.end());
  measured.threads = threads;
  measured.mean_seconds = seconds / static_cast<double>(scans.size());
  measured.median_seconds = quantile(by_scan, 0.5);
  measured.p90_seconds = quantile(by_scan, 0.9);
  measured.total_seconds = seconds;
  measured.load_seconds = scans.waited_seconds();
  for (const StageTimes::Stage& stage : times.stages()) {
    measured.stages.push_back({stage.name, stage.seconds});
  }
  return measured;
}

/// An external program reads files, so that the order of its reading cannot be checked.
std::optional<OnlineRule> online_rule(const MethodTask& task) {
  const ConfiguredMethod& method = task.request->method;
  if (!method.variant.online || !method.entry->manifest.empty()) return std::nullopt;
  const auto delay = std::find_if(method.configuration.begin(), method.configuration.end(),
                                  [](const auto& setting) { return setting.first == "delay"; });
  const double* seconds =
      delay == method.configuration.end() ? nullptr : std::get_if<double>(&delay->second);
  return OnlineRule{task.request->name, seconds != nullptr ? *seconds : 0.0, task.options.threads};
}

/// The store of an answer's pieces, one for each scan.
ScanSpool spool_of(const MethodTask& task, const char* what) {
  const std::size_t scans = task.sequence->scans->size();
  return task.spool_beside.empty() ? ScanSpool(scans) : ScanSpool(scans, task.spool_beside, what);
}

}  // namespace

MethodAnswer run_remover(Remover& remover, const MethodTask& task) {
  const std::string& name = task.request->name;
  // The frames of all methods. Masks are by point index, so they need no transformation back.
  const LocalFrameSource local(*task.sequence->scans, task.sequence->method_frame(),
                               spin_axis_of(*task.sequence));
  const TimedSource scans(local, online_rule(task));
  CheckedSink sink(name, scans, MaskStore(spool_of(task, "masks")));
  StageTimes times;
  RunContext context;
  context.threads = task.options.threads;
  context.progress = task.progress;
  context.times = &times;
  context.cancel = task.cancel;
  CheckedReasons reasons(name, scans);
  if (task.options.with_reasons) context.reasons = &reasons;
  std::optional<CheckedConfidence> confidence;
  if (task.options.with_confidence && !task.request->method.entry->confidence.empty()) {
    context.evidence = &confidence.emplace(name, task.request->method.entry->confidence, scans,
                                           spool_of(task, "confidence"));
  }
  const bool was_reset = reset_peak_memory();
  const auto started = std::chrono::steady_clock::now();
  remover.run(scans, sink, context);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
  const double seconds = std::max(0.0, wall.count() - scans.waited_seconds());
  MethodAnswer answer;
  answer.measured = measure(times, scans, seconds, task.options.threads);
  answer.measured.peak_memory_mib = peak_since_reset(was_reset);
  answer.masks = sink.finish();
  answer.reasons = reasons.finish();
  if (confidence) answer.confidence = confidence->finish();
  return answer;
}

MethodAnswer run_method(const MethodTask& task) {
  MethodAnswer failed;
  const auto fail = [&](CellStatus status, const std::string& reason) {
    failed.status = status;
    failed.reason = reason;
  };
  try {
    return run_remover(*make_remover(task.request->method, *task.sequence), task);
  } catch (const Cancelled&) {
    throw;
  } catch (const DataError& error) {
    fail(CellStatus::kBadData, error.what());
  } catch (const std::bad_alloc&) {
    fail(CellStatus::kOutOfMemory, "there was not enough memory");
  } catch (const std::exception& error) {
    fail(CellStatus::kFailed, error.what());
  } catch (...) {
    fail(CellStatus::kFailed, "the method threw an exception of an unknown type");
  }
  return failed;
}

void check_has_labels(const Sequence& sequence) {
  if (sequence.labels != nullptr) return;
  throw DataError(
      fmt::format("sequence '{}' has no labels, so nothing can be scored on it; expected {}. To "
                  "clean a map without labels use `raymoval clean`.",
                  sequence.name, layout_of(sequence).expected_labels));
}

std::unique_ptr<Remover> make_remover(const ConfiguredMethod& method, const Sequence& sequence) {
  if (!method.entry->needs_truth) return with_split_sensors(method.make(), sequence);
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
