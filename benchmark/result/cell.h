// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "benchmark/process/method_run.h"
#include "benchmark/run/sequence_bench.h"
#include "benchmark/suite/suite.h"
#include "core/process/child_process.h"

namespace raymoval {

/// Version of the layout of cell.json, run.json and results.json.
inline constexpr int kSchemaVersion = 1;

/// A cell: one sequence, one method with one set of parameters, scored by every protocol.
struct CellTask {
  SequenceBench* bench = nullptr;
  const MethodRequest* request = nullptr;
  std::filesystem::path removals;  ///< Folder for label files; empty: none are written.
  const std::atomic<bool>* cancel = nullptr;
  const SequenceRequest* place = nullptr;  ///< Where a process of its own opens the sequence; null:
                                           ///< the method runs in this process.
  ChildLimits limits;
};

/// All that the counts of a cell depend on: method with its parameters and version, data, protocols
/// with their options and versions.
nlohmann::ordered_json cell_identity(SequenceBench& bench, const MethodRequest& request);

/// Hash of the identity. Any change changes the key.
std::string cell_key(SequenceBench& bench, const MethodRequest& request);

/// Why a cell with the parts `stored` of an identity is not one with `wanted`: "parameter tau0 was
/// 0.2, is 0.4"; empty if nothing differs.
std::string identity_difference(const nlohmann::ordered_json& stored,
                                const nlohmann::ordered_json& wanted);

/// "parameter tau0 was 0.2, is 0.4" for the first part of two records that differs; empty if none
/// does. @param what stands before the part's name
std::string record_difference(const std::string& what, const nlohmann::ordered_json& stored,
                              const nlohmann::ordered_json& wanted);

/// The same of two lists of protocols, by their names. What only `stored` has of a protocol, such
/// as counts and rates, does not matter.
std::string protocol_difference(const nlohmann::ordered_json& stored,
                                const nlohmann::ordered_json& wanted);

/// Runs the method, checks its answer and scores it. Never throws for a fault of the method or the
/// data: that is a cell with a status and a reason.
/// @return the content of cell.json; all that varies from run to run stands below "measured"
/// @throws Cancelled, or DataError if the removals cannot be written
nlohmann::ordered_json execute_cell(const CellTask& task);

/// The method once more, for its time. @throws Cancelled
MethodAnswer repeat_cell(const CellTask& task);

/// The cell of a sequence that cannot be read: status "bad_data".
nlohmann::ordered_json unreadable_cell(const std::string& sequence, const MethodRequest& request,
                                       const std::string& reason);

/// Counts and rates as JSON; an undefined rate is null, its reason stands below "undefined".
nlohmann::ordered_json to_json(const ProtocolResult& result);

}  // namespace raymoval
