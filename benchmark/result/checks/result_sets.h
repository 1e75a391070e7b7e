// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "eval/comparison/compare.h"

namespace raymoval {

/// results.json of a run: `given` is its folder or the file itself.
/// @throws UsageError if there is none
std::filesystem::path find_results(const std::string& given);

/// What a comparison sees of a results.json.
/// @throws DataError if it is damaged, incomplete or of another schema version
ResultSet read_result_set(const std::filesystem::path& results);

/// Writes `results` to `reference` without what depends on the machine or the moment: build,
/// machine, times and memory. `with_times` keeps machine, times and memory, so that a comparison
/// can tell whether a run is slower.
/// @throws UsageError if the run has failed cells or its controls are off, or if times are asked
/// for and it has none
void write_reference(const std::filesystem::path& results, const std::filesystem::path& reference,
                     bool with_times = false);

}  // namespace raymoval
