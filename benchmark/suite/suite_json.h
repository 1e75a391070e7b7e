// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "benchmark/suite/suite.h"

namespace raymoval {

/// Where a sequence is and how it is opened, as run.json has it.
nlohmann::ordered_json to_json(const SequenceRequest& place);

/// Reads it again. @throws nlohmann::json::exception, or UsageError for a text that means nothing
SequenceRequest place_from(const nlohmann::ordered_json& json);

/// Refuses a suite whose paths run.json and the messages to the processes of methods cannot hold:
/// JSON has no bytes that are not UTF-8, and with others in their place a path leads nowhere.
/// @throws UsageError that names the path and the remedy; DataError as `absolute_place`
void check_paths_fit_json(const Suite& suite);

}  // namespace raymoval
