// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/result/run_record.h"
#include "eval/comparison/compare.h"

namespace raymoval {

// Each of these says in words the first part in which two records differ, "parameter tau0 was 0.2,
// is 0.4", and gives an empty text if they do not differ.

/// Why a stored cell is not the one that is wanted.
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

/// What of a cell must be equal for two cells to be comparable: data, method and parameters.
Facts comparison_facts(const Cell& cell);

/// The same of one of its scores: protocol, version and options.
Facts comparison_facts(const Score& score);

}  // namespace raymoval
