// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "benchmark/sequence_bench.h"
#include "benchmark/suite.h"

namespace raymoval {

/// Version of the layout of cell.json, run.json and results.json.
inline constexpr int kSchemaVersion = 1;

/// A cell: one sequence, one method with one set of parameters, scored by every protocol.
struct CellTask {
  SequenceBench* bench = nullptr;
  const MethodRequest* request = nullptr;
  std::filesystem::path removals;  ///< Folder for label files; empty: none are written.
  const std::atomic<bool>* cancel = nullptr;
};

/// Identity of a cell: everything that its counts depend on. Any change changes the key.
std::string cell_key(const CellTask& task);

/// Runs the method, checks its answer and scores it. Never throws for a fault of the method or the
/// data: that is a cell with a status and a reason.
/// @return the content of cell.json; all that varies from run to run stands below "measured"
/// @throws Cancelled
nlohmann::ordered_json execute_cell(const CellTask& task);

/// The cell of a sequence that cannot be read: status "bad_data".
nlohmann::ordered_json unreadable_cell(const std::string& sequence, const MethodRequest& request,
                                       const std::string& reason);

/// The remover of `method`; one that needs the truth answers from the labels.
/// @throws DataError if it needs labels and there are none
std::unique_ptr<Remover> make_remover(const ConfiguredMethod& method, const Sequence& sequence);

/// Counts and rates as JSON; an undefined rate is null, its reason stands below "undefined".
nlohmann::ordered_json to_json(const ProtocolResult& result);

}  // namespace raymoval
