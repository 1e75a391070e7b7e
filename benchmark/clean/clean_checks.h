// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.h"
#include "datasets/inspection/evidence/finding.h"
#include "datasets/sequence.h"

namespace raymoval {

/// Looks for mistakes in the data before a map is made of it, as `raymoval inspect` does, and says
/// on standard error what may make the map worse (see `Consequence`).
/// @param path what the user called the sequence, for the message
/// @param force goes on where the map would be wrong, and says so
/// @param cancel the check is given up when this becomes true
/// @return the findings in spite of which the map is made
/// @throws DataError with the findings for which it would be wrong; Cancelled
std::vector<Finding> check_data(const Sequence& sequence, const std::string& path, bool force,
                                Progress& progress, const std::atomic<bool>& cancel);

/// Warns on standard error if no point was removed, or more than half of them.
void check_removed(std::uint64_t removed, std::uint64_t points, const std::string& path);

}  // namespace raymoval
