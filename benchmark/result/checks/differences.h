// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/result/run_record.h"
#include "eval/comparison/compare.h"

namespace raymoval {

// Each function returns the first difference of two records in words, "parameter tau0 was 0.2, is
// 0.4", or an empty text if there is none.

/// The difference of a stored cell from the wanted cell.
std::string identity_difference(const Cell& stored, const CellIdentity& wanted);

/// Parameters and version of a cell's method against those of a suite's.
std::string method_difference(const MethodRecord& stored, const SuiteMethodRecord& wanted);

/// The data of a sequence, its fingerprint included.
std::string data_difference(const DataRecord& stored, const DataRecord& wanted);

/// Two lists of protocols, matched by their names.
std::string protocol_difference(const std::vector<ProtocolRecord>& stored,
                                const std::vector<ProtocolRecord>& wanted);

/// The protocols that a cell was scored by.
std::vector<ProtocolRecord> protocols_of(const Cell& cell);

/// The facts that must be equal in comparable cells: data, method and parameters.
Facts comparison_facts(const Cell& cell);

/// The facts that must be equal in comparable scores: protocol, version and options.
Facts comparison_facts(const Score& score);

}  // namespace raymoval
