// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "benchmark/suite/suite.h"

namespace raymoval {

/// The place of a sequence and its reading options, in the form of run.json.
nlohmann::ordered_json to_json(const SequenceRequest& place);

/// Reads the JSON of `to_json`. @throws nlohmann::json::exception, or UsageError for an unknown
/// text
SequenceRequest place_from(const nlohmann::ordered_json& json);

/// Refuses a suite whose paths run.json and the messages to the processes of methods cannot hold:
/// JSON allows only UTF-8, and a path with replaced bytes would not exist.
/// @throws UsageError that names the path and the remedy; DataError as `absolute_place`
void check_paths_fit_json(const Suite& suite);

}  // namespace raymoval
