// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/result/cell.h"

namespace raymoval {

/// A cleaned map that was scored.
struct CloudRecord {
  std::size_t points = 0;       ///< Number of points in the file.
  std::size_t non_finite = 0;   ///< Those that were left out, see `CleanedCloud`.
  double oracle_voxel_m = 0.0;  ///< Voxel to which the oracle's cloud was thinned; 0 if it was not.
  std::vector<std::string> warnings;
};

/// What one protocol says.
struct ScoredProtocol {
  ProtocolRecord protocol;
  ProtocolResult result;
  /// What the oracle's cloud scores. No value where label files were scored.
  std::optional<ProtocolResult> oracle = std::nullopt;
};

/// What `raymoval score` tells.
struct ScoreRecord {
  DataRecord data;
  std::optional<CloudRecord> cloud;  ///< No value where label files were scored.
  std::vector<ScoredProtocol> protocols;
  ColumnRecord columns;
};

/// The record as lines for people. See `to_json` for programs.
std::string score_text(const ScoreRecord& record);

}  // namespace raymoval
