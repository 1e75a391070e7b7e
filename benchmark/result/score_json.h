// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "benchmark/result/results.h"
#include "eval/bootstrap.h"
#include "eval/columns/columns.h"

namespace raymoval {

/// Each column as part, whole and percent; null with a reason where undefined.
nlohmann::ordered_json columns_record(const std::vector<ColumnValue>& columns);

/// How the intervals were drawn, and [low, high] of each rate; null with a reason where undefined.
nlohmann::ordered_json to_json(const Intervals& intervals);

/// Adds the columns of a cell.json to those of its method; nothing if it has none.
void add_columns(const nlohmann::ordered_json& cell, RunResults& results);

/// Reads the intervals of a protocol's record of a cell.json; nothing if it has none.
void add_intervals(const nlohmann::ordered_json& scored, ResultRow& row);

}  // namespace raymoval
