// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "benchmark/cli/commands/score_record.h"
#include "benchmark/cli/description.h"
#include "benchmark/run/plan.h"
#include "datasets/inspection/inspect.h"

namespace raymoval {

// What commands print as JSON. Keys and their order are part of the program's interface.

/// `raymoval describe --json`.
nlohmann::ordered_json to_json(const Description& description);

/// A line of `raymoval plan`.
/// @param looked whether the run folder was looked at, so that `cell` says what is to be run
nlohmann::ordered_json to_json(const PlannedCell& cell, bool looked);

/// "note" or "finding".
const char* severity_name(Severity severity);

/// `raymoval inspect --json`.
nlohmann::ordered_json to_json(const InspectionReport& report);

/// `raymoval score --json`.
nlohmann::ordered_json to_json(const ScoreRecord& record);

}  // namespace raymoval
