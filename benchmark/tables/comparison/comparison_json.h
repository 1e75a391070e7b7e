// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "benchmark/tables/comparison/comparison_files.h"

namespace raymoval {

/// A comparison as results/schema/comparison.schema.json says.
nlohmann::ordered_json to_json(const Comparison& comparison, const ComparisonSubject& subject);

}  // namespace raymoval
