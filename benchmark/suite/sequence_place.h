// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "benchmark/suite/suite.h"

namespace raymoval {

/// Where and how a sequence is opened, as JSON, and back. @throws nlohmann::json::exception
nlohmann::ordered_json place_record(const SequenceRequest& place);
SequenceRequest place_from(const nlohmann::ordered_json& record);

/// The same place for whoever stands in another folder: paths absolute, scenes by name as they are.
SequenceRequest absolute_place(const SequenceRequest& place);

}  // namespace raymoval
