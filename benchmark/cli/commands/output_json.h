// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/cli/commands/score_record.h"
#include "benchmark/cli/description.h"
#include "benchmark/run/plan.h"
#include "datasets/inspection/inspect.h"

namespace raymoval {

// What commands print as JSON. Keys and their order are part of the program's interface.

/// `raymoval describe --json`.
std::string output_json(const Description& description);

/// A line of `raymoval plan`.
/// @param looked whether the run folder was looked at, so that `cell` says what is to be run
std::string output_json_line(const PlannedCell& cell, bool looked);

/// "note" or "finding".
const char* severity_name(Severity severity);

/// `raymoval inspect --json`.
std::string output_json(const InspectionReport& report);

/// `raymoval score --json`.
std::string output_json(const ScoreRecord& record);

}  // namespace raymoval
