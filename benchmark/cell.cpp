// SPDX-License-Identifier: MIT
#include "benchmark/cell.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <nlohmann/json.hpp>

#include "benchmark/checked_sink.h"
#include "benchmark/machine.h"
#include "benchmark/removal_files.h"
#include "benchmark/score_json.h"
#include "benchmark/sealed_json.h"
#include "core/files.h"
#include "methods/controls/controls.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

/// Value below which `share` of the sorted values lie (nearest rank); null without values.
ordered_json quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return nullptr;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

struct MethodRun {
  MaskStore masks;
  ordered_json measured;
};

/// @param seconds wall time of the method without its waiting for scans
ordered_json measured_record(const StageTimes& times, const TimedSource& scans, double seconds,
                             int threads, bool peak_is_own) {
  std::vector<double> by_scan = times.seconds_by_scan();
  std::sort(by_scan.begin(), by_scan.end());
  ordered_json record;
  record["threads"] = threads;
  record["seconds_per_scan"]["mean"] = seconds / static_cast<double>(scans.size());
  record["seconds_per_scan"]["median"] = quantile(by_scan, 0.5);
  record["seconds_per_scan"]["p90"] = quantile(by_scan, 0.9);
  record["seconds_total"] = seconds;
  record["seconds_load"] = scans.waited_seconds();
  record["stages"] = ordered_json::array();
  for (const StageTimes::Stage& stage : times.stages()) {
    record["stages"].push_back({{"name", stage.name}, {"seconds", stage.seconds}});
  }
  const auto peak = peak_memory_mib();
  record["peak_memory_mib"] = peak && peak_is_own ? ordered_json(*peak) : nullptr;
  return record;
}

MethodRun run_method(const CellTask& task) {
  SequenceBench& bench = *task.bench;
  const ConfiguredMethod& method = task.request->method;
  const auto remover = make_remover(method, bench.sequence());
  const TimedSource scans(*bench.sequence().scans);
  CheckedSink sink(task.request->name, scans);
  StageTimes times;
  RunContext context;
  context.threads = bench.threads();
  context.progress = bench.progress();
  context.times = &times;
  context.cancel = task.cancel;
  const bool peak_is_own = reset_peak_memory();
  const auto started = std::chrono::steady_clock::now();
  remover->run(scans, sink, context);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
  const double seconds = std::max(0.0, wall.count() - scans.waited_seconds());
  ordered_json measured = measured_record(times, scans, seconds, bench.threads(), peak_is_own);
  return {sink.finish(), std::move(measured)};
}

ordered_json method_record(const MethodRequest& request) {
  const MethodEntry& entry = *request.method.entry;
  ordered_json record;
  record["name"] = entry.name;
  record["variant"] = request.method.variant.name;
  record["version"] = entry.version;
  record["online"] = request.method.variant.online;
  record["control"] = is_control(entry.name);
  record["parameters"] = to_json(request.method.configuration);
  return record;
}

ordered_json data_record(SequenceBench& bench) {
  ordered_json record = bench.sequence().record();
  record["scans"] = bench.sequence().scans->size();
  record["fingerprint"] = bench.data_fingerprint();
  return record;
}

ordered_json protocol_record(const SequenceBench& bench, std::size_t i) {
  const Protocol& protocol = bench.protocol(i);
  ordered_json record;
  record["name"] = bench.protocol_name(i);
  record["protocol"] = protocol.name();
  record["version"] = protocol.version();
  record["options"] = to_json(protocol.options());
  return record;
}

void score_all(const CellTask& task, const MaskStore& masks, ordered_json& cell) {
  for (std::size_t i = 0; i < task.bench->protocol_count(); ++i) {
    if (task.cancel != nullptr && task.cancel->load()) throw Cancelled();
    ordered_json record = protocol_record(*task.bench, i);
    record.update(to_json(task.bench->score(i, masks)));
    cell["protocols"].push_back(std::move(record));
  }
  cell["columns"] = columns_record(task.bench->columns(masks));
}

/// Everything of a cell that is known before the method runs.
ordered_json cell_head(const std::string& sequence, const MethodRequest& request) {
  ordered_json cell;
  cell["schema_version"] = kSchemaVersion;
  cell["sequence"] = sequence;
  cell["name"] = request.name;
  cell["key"] = nullptr;
  cell["status"] = "ok";
  cell["reason"] = "";
  cell["output_tail"] = "";
  cell["method"] = method_record(request);
  cell["data"] = nullptr;
  cell["protocols"] = ordered_json::array();
  cell["columns"] = nullptr;
  cell["masks"] = nullptr;
  cell["measured"] = nullptr;
  return cell;
}

void fail(ordered_json& cell, const char* status, const std::string& reason) {
  cell["status"] = status;
  cell["reason"] = reason;
  cell["protocols"] = ordered_json::array();
  cell["columns"] = nullptr;
}

void fill_cell(const CellTask& task, ordered_json& cell) {
  MethodRun run = run_method(task);
  cell["measured"] = std::move(run.measured);
  cell["masks"]["digest"] = mask_digest(run.masks);
  cell["masks"]["removed"] = run.masks.removed_count();
  score_all(task, run.masks, cell);
  if (task.removals.empty()) return;
  Progress* progress = task.bench->progress();
  const ScanSource& scans = *task.bench->sequence().scans;
  if (progress != nullptr) progress->begin("writing removals", scans.size());
  write_removals(task.removals, scans, run.masks, [&] {
    if (progress != nullptr) progress->advance();
  });
}

}  // namespace

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

std::string cell_key(const CellTask& task) {
  ordered_json identity;
  identity["schema_version"] = kSchemaVersion;
  identity["method"] = method_record(*task.request);
  identity["data"] = data_record(*task.bench);
  identity["columns"]["version"] = kColumnsVersion;
  for (std::size_t i = 0; i < task.bench->protocol_count(); ++i) {
    identity["protocols"].push_back(protocol_record(*task.bench, i));
  }
  return content_hash(json_text(identity));
}

ordered_json execute_cell(const CellTask& task) {
  ordered_json cell = cell_head(task.bench->sequence().name, *task.request);
  cell["key"] = cell_key(task);
  cell["data"] = data_record(*task.bench);
  try {
    fill_cell(task, cell);
  } catch (const Cancelled&) {
    throw;
  } catch (const DataError& error) {
    fail(cell, "bad_data", error.what());
  } catch (const std::bad_alloc&) {
    fail(cell, "out_of_memory", "there was not enough memory");
  } catch (const std::exception& error) {
    fail(cell, "failed", error.what());
  } catch (...) {
    fail(cell, "failed", "the method threw something that is no std::exception");
  }
  return cell;
}

ordered_json unreadable_cell(const std::string& sequence, const MethodRequest& request,
                             const std::string& reason) {
  ordered_json cell = cell_head(sequence, request);
  fail(cell, "bad_data", reason);
  return cell;
}

ordered_json to_json(const ProtocolResult& result) {
  ordered_json record;
  record["counts"] = ordered_json::object();
  for (const auto& [name, count] : result.counts) record["counts"][name] = count;
  record["rates"] = ordered_json::object();
  record["undefined"] = ordered_json::object();
  for (const Rate& rate : result.rates) {
    const bool defined = rate.value.has_value() && std::isfinite(*rate.value);
    record["rates"][rate.name] = defined ? ordered_json(*rate.value) : nullptr;
    if (!defined) record["undefined"][rate.name] = rate.undefined_reason;
  }
  record["warnings"] = result.warnings;
  if (result.intervals) record["intervals"] = to_json(*result.intervals);
  return record;
}

}  // namespace raymoval
