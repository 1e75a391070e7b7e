// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "benchmark/history/history.h"

namespace raymoval {

/// Tracks with their events and changes, as `raymoval history --format json` prints them.
nlohmann::ordered_json to_json(const std::vector<HistoryTrack>& tracks);

}  // namespace raymoval
