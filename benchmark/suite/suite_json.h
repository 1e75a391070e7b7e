// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "benchmark/suite/suite.h"

namespace raymoval {

/// Where a sequence is and how it is opened, as run.json has it.
nlohmann::ordered_json to_json(const SequenceRequest& place);

/// Reads it again. @throws nlohmann::json::exception, or UsageError for a text that means nothing
SequenceRequest place_from(const nlohmann::ordered_json& json);

}  // namespace raymoval
