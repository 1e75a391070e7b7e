// SPDX-License-Identifier: MIT
#include "benchmark/result/cell.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <nlohmann/json.hpp>

#include "benchmark/process/checked_sink.h"
#include "benchmark/process/method_process.h"
#include "benchmark/result/reasons.h"
#include "benchmark/result/removal_files.h"
#include "benchmark/result/score_json.h"
#include "benchmark/result/sealed_json.h"
#include "core/files/files.h"
#include "methods/external/external.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

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

void write_cell_removals(const CellTask& task, const MethodAnswer& answer) {
  Progress* progress = task.bench->progress();
  const ScanSource& scans = *task.bench->sequence().scans;
  if (progress != nullptr) progress->begin("writing removals", scans.size());
  write_removals(task.removals, scans, answer.masks, [&] {
    if (task.cancel != nullptr && task.cancel->load()) throw Cancelled();
    if (progress != nullptr) progress->advance();
  });
  write_reasons(task.removals, scans, answer.reasons);
}

/// Whether a mask per scan came back from the child, each as long as the scan it is for.
void check_masks(const MethodAnswer& answer, const ScanSource& scans) {
  if (answer.masks.size() == scans.size()) return;
  throw MethodError("answered for " + std::to_string(answer.masks.size()) + " scans, expected " +
                    std::to_string(scans.size()) + "; the data changed while it ran");
}

void fill_cell(const CellTask& task, const MethodAnswer& answer, ordered_json& cell) {
  check_masks(answer, *task.bench->sequence().scans);
  cell["measured"] = to_json(answer.measured);
  cell["masks"]["digest"] = mask_digest(answer.masks);
  cell["masks"]["removed"] = answer.masks.removed_count();
  score_all(task, answer.masks, cell);
}

/// "parameter tau0 was 0.2, is 0.4" for the first part of `wanted` that `stored` has otherwise.
std::string first_change(const std::string& what, const ordered_json& stored,
                         const ordered_json& wanted) {
  for (const auto& [key, value] : wanted.items()) {
    const std::string name = what.empty() ? key : what + " " + key;
    if (!stored.contains(key)) return name + " is new";
    if (value.is_object() && stored[key].is_object()) {
      const std::string inner = first_change(name, stored[key], value);
      if (!inner.empty()) return inner;
    } else if (stored[key] != value) {
      return name + " was " + stored[key].dump() + ", is " + value.dump();
    }
  }
  return "";
}

}  // namespace

std::string record_difference(const std::string& what, const ordered_json& stored,
                              const ordered_json& wanted) {
  const std::string change = first_change(what, stored, wanted);
  if (!change.empty()) return change;
  for (const auto& [key, value] : stored.items()) {
    if (!wanted.contains(key)) return (what.empty() ? key : what + " " + key) + " is no more";
  }
  return "";
}

std::string protocol_difference(const ordered_json& stored, const ordered_json& wanted) {
  std::vector<std::string> names;
  for (const ordered_json& protocol : wanted) {
    const auto name = protocol.at("name").get<std::string>();
    names.push_back(name);
    const auto known = std::find_if(stored.begin(), stored.end(),
                                    [&](const auto& item) { return item.at("name") == name; });
    if (known == stored.end()) return "protocol " + name + " is new";
    ordered_json identity;  // Without counts and rates.
    for (const auto& [key, value] : protocol.items()) identity[key] = known->value(key, value);
    const std::string inner = record_difference("protocol " + name, identity, protocol);
    if (!inner.empty()) return inner;
  }
  for (const ordered_json& protocol : stored) {
    const auto name = protocol.at("name").get<std::string>();
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      return "protocol " + name + " is no more asked for";
    }
  }
  return "";
}

ordered_json cell_identity(SequenceBench& bench, const MethodRequest& request) {
  ordered_json identity;
  identity["schema_version"] = kSchemaVersion;
  identity["method"] = method_record(request);
  identity["data"] = data_record(bench);
  identity["columns"]["version"] = kColumnsVersion;
  for (std::size_t i = 0; i < bench.protocol_count(); ++i) {
    identity["protocols"].push_back(protocol_record(bench, i));
  }
  return identity;
}

std::string cell_key(SequenceBench& bench, const MethodRequest& request) {
  return content_hash(json_text(cell_identity(bench, request)));
}

std::string identity_difference(const ordered_json& stored, const ordered_json& wanted) {
  try {
    // What a reader knows comes before hashes.
    const ordered_json& method = wanted.at("method");
    std::string found = record_difference("parameter", stored.at("method").at("parameters"),
                                          method.at("parameters"));
    if (found.empty()) found = record_difference("method", stored.at("method"), method);
    if (found.empty()) {
      found = protocol_difference(stored.at("protocols"), wanted.at("protocols"));
    }
    if (found.empty()) found = record_difference("data", stored.at("data"), wanted.at("data"));
    if (found.empty()) {
      ordered_json rest = wanted;
      for (const char* known : {"method", "data", "protocols"}) rest.erase(known);
      found = first_change("", stored, rest);
    }
    return found.empty() ? "it was made otherwise" : found;
  } catch (const ordered_json::exception&) {
    return "its file is of another layout";
  }
}

namespace {

MethodAnswer answer_of_method(const CellTask& task) {
  const MethodTask method{&task.bench->sequence(), task.request, task.bench->threads(),
                          task.bench->progress(),  task.cancel,  !task.removals.empty()};
  return task.place == nullptr ? run_method(method)
                               : run_method_apart(method, *task.place, task.limits);
}

/// What is not as the key says of an external method, whose files anybody may change; else empty.
std::string changed_program(const MethodEntry& entry) {
  if (entry.manifest.empty()) return "";
  try {
    const std::string now = external_entry(entry.manifest).version;
    if (now == entry.version) return "";
    return entry.manifest + ": the manifest or files of the program changed during the run " +
           "(version " + entry.version + ", now " + now + "). Run again; 'files' of the manifest " +
           "must not name what the program itself writes.";
  } catch (const Error& error) {
    return error.what();
  }
}

/// The method's answer, which is only "ok" if the method and what it read are those of the key.
MethodAnswer method_answer(const CellTask& task) {
  MethodAnswer answer;
  answer.status = "failed";
  answer.reason = changed_program(*task.request->method.entry);
  if (!answer.reason.empty()) return answer;
  answer = answer_of_method(task);
  if (answer.status != "ok") return answer;
  answer.reason = changed_program(*task.request->method.entry);
  if (!answer.reason.empty()) answer.status = "failed";
  const std::string change = task.bench->data_change(answer.loaded ? &*answer.loaded : nullptr);
  if (!change.empty()) {
    answer.status = "bad_data";
    answer.reason = change;
  }
  return answer;
}

}  // namespace

ordered_json execute_cell(const CellTask& task) {
  ordered_json cell = cell_head(task.bench->sequence().name, *task.request);
  cell["key"] = cell_key(*task.bench, *task.request);
  cell["data"] = data_record(*task.bench);
  const MethodAnswer answer = method_answer(task);
  cell["output_tail"] = answer.output_tail;
  if (answer.status != "ok") {
    fail(cell, answer.status.c_str(), answer.reason);
    return cell;
  }
  try {
    fill_cell(task, answer, cell);
    // Scoring reads the data once more.
    const std::string change = task.bench->data_change(nullptr);
    if (!change.empty()) fail(cell, "bad_data", change);
  } catch (const Cancelled&) {
    throw;
  } catch (const DataError& error) {
    fail(cell, "bad_data", error.what());
  } catch (const std::bad_alloc&) {
    fail(cell, "out_of_memory", "there was not enough memory");
  } catch (const std::exception& error) {
    fail(cell, "failed", error.what());
  }
  // A disk that is full is no fault of the method: it ends the run.
  if (cell["status"] == "ok" && !task.removals.empty()) write_cell_removals(task, answer);
  return cell;
}

MethodAnswer repeat_cell(const CellTask& task) {
  return method_answer(task);
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
