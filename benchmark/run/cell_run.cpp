// SPDX-License-Identifier: MIT
#include "benchmark/run/cell_run.h"

#include <fmt/format.h>

#include <chrono>
#include <new>

#include "benchmark/process/checked_sink.h"
#include "benchmark/process/method_process.h"
#include "benchmark/result/cell_json.h"
#include "benchmark/result/removals/reasons.h"
#include "benchmark/result/removals/removal_files.h"
#include "core/error.h"
#include "core/files/file_kind.h"

namespace raymoval {
namespace {

MethodRecord method_record(const MethodRequest& request) {
  const MethodEntry& entry = *request.method.entry;
  return {entry.name,
          request.method.variant.name,
          entry.version,
          request.method.variant.online,
          is_control(entry.name),
          request.method.configuration};
}

DataRecord data_record(ScoredSequence& scored) {
  DataRecord data = scored.sequence().record();
  data.fingerprint = scored.data_fingerprint();
  return data;
}

ProtocolRecord protocol_record(const ScoredSequence& scored, std::size_t i) {
  const Protocol& protocol = scored.protocol(i);
  return {scored.protocol_name(i), protocol.name(), protocol.version(), protocol.options()};
}

void write_cell_removals(const std::filesystem::path& removals, const MethodTask& task,
                         const MethodAnswer& answer) {
  const ScanSource& scans = *task.sequence->scans;
  if (task.progress != nullptr) task.progress->begin("writing removals", scans.size());
  if (!has_folder(removals.parent_path())) {
    throw DataError(removals.parent_path().string() +
                    ": is no longer there; the folder of the run was moved or removed meanwhile.");
  }
  try {
    write_removals(removals, scans, answer.masks, [&] {
      throw_if_cancelled(task.cancel);
      if (task.progress != nullptr) task.progress->advance();
    });
    write_reasons(removals, scans, answer.reasons);
  } catch (...) {
    (void)if_whole([&] { return remove_removals(removals); });
    throw;
  }
}

/// @throws MethodError unless the child gave one mask for each scan
void check_masks(const MethodAnswer& answer, const ScanSource& scans) {
  if (answer.masks.size() == scans.size()) return;
  throw MethodError(fmt::format("answered for {} scans, expected {}; the data changed while it ran",
                                answer.masks.size(), scans.size()));
}

void score_masks(ScoredSequence& scored, const MethodTask& task, const MethodAnswer& answer,
                 Cell& cell) {
  check_masks(answer, *task.sequence->scans);
  cell.measured = answer.measured;
  cell.masks = MaskRecord{mask_digest(answer.masks),
                          static_cast<std::int64_t>(answer.masks.removed_count())};
  throw_if_cancelled(task.cancel);
  SequenceScores scores = scored.score(answer.masks, task.cancel, answer.confidence);
  for (std::size_t i = 0; i < scores.protocols.size(); ++i) {
    ProtocolResult& result = scores.protocols[i];
    cell.scores.push_back({protocol_record(scored, i), std::move(result.counts),
                           std::move(result.rates), std::move(result.warnings),
                           std::move(result.intervals), std::move(result.by_scan)});
  }
  cell.columns = ColumnRecord{kColumnsVersion, std::move(scores.columns)};
  cell.reliability = scores.reliability;
}

/// The masks of a control follow from the labels, so no process is started and no scan is read.
/// They are scored like any other masks.
MethodAnswer answer_of_control(ScoredSequence& scored, KnownAnswer known) {
  const auto started = std::chrono::steady_clock::now();
  const MaskStore& moving = scored.moving_points();
  MethodAnswer answer;
  answer.masks = MaskStore(moving.size());
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const bool by_label = known == KnownAnswer::kMovingPointsRemoved;
    const bool all = known == KnownAnswer::kEverythingRemoved;
    answer.masks.set(i, by_label ? moving.get(i) : Mask(moving.point_count(i), all ? 1 : 0));
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  answer.measured.total_seconds = elapsed.count();
  answer.measured.mean_seconds = elapsed.count() / static_cast<double>(moving.size());
  return answer;
}

MethodAnswer answer_of_method(ScoredSequence& scored, const MethodTask& task) {
  if (task.place == nullptr) return run_method(task);
  const auto known = known_answer(task.request->method.entry->name);
  return known ? answer_of_control(scored, *known) : run_method_in_child(task);
}

/// Scores an answer. After a fault of the method or the data, the cell has no result.
void score_answer(ScoredSequence& scored, const MethodTask& task, const MethodAnswer& answer,
                  Cell& cell) {
  try {
    score_masks(scored, task, answer, cell);
  } catch (const Cancelled&) {
    throw;
  } catch (const DataError& error) {
    cell.fail(CellStatus::kBadData, error.what());
  } catch (const std::bad_alloc&) {
    cell.fail(CellStatus::kOutOfMemory, "there was not enough memory");
  } catch (const std::exception& error) {
    cell.fail(CellStatus::kFailed, error.what());
  }
}

}  // namespace

CellIdentity cell_identity(ScoredSequence& scored, const MethodRequest& request) {
  CellIdentity identity{method_record(request), data_record(scored), {}};
  for (std::size_t i = 0; i < scored.protocol_count(); ++i) {
    identity.protocols.push_back(protocol_record(scored, i));
  }
  return identity;
}

std::string current_key(ScoredSequence& scored, const MethodRequest& request) {
  return cell_key(cell_identity(scored, request));
}

Cell execute_cell(ScoredSequence& scored, const MethodTask& task,
                  const std::filesystem::path& removals) {
  CellIdentity identity = cell_identity(scored, *task.request);
  Cell cell{task.sequence->name, task.request->name, cell_key(identity)};
  cell.method = std::move(identity.method);
  cell.data = std::move(identity.data);
  const MethodAnswer answer = answer_of_method(scored, task);
  cell.output_tail = answer.output_tail;
  if (answer.status != CellStatus::kOk) {
    cell.fail(answer.status, answer.reason);
    return cell;
  }
  score_answer(scored, task, answer, cell);
  // A full disk is not a fault of the method: it ends the run.
  if (cell.ok() && !removals.empty()) write_cell_removals(removals, task, answer);
  return cell;
}

Cell unreadable_cell(const std::string& sequence, const MethodRequest& request,
                     const std::string& reason) {
  Cell cell{sequence, request.name, ""};
  cell.method = method_record(request);
  cell.fail(CellStatus::kBadData, reason);
  return cell;
}

}  // namespace raymoval
