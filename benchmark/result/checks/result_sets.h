// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "eval/comparison/compare.h"

namespace raymoval {

/// results.json of a run: `given` is its folder or the file itself.
/// @throws UsageError if there is none
std::filesystem::path find_results(const std::string& given);

/// The part of a results.json that is compared.
/// @throws DataError if it is damaged, incomplete or of another schema version
ResultSet read_result_set(const std::filesystem::path& results);

/// Writes `results` to `reference` without the parts that depend on the machine or the run: build,
/// machine, times and memory. `with_times` keeps machine, times and memory, so that a comparison
/// can find slower runs.
/// @throws UsageError if the run has failed cells or unexpected rates of controls, or if it has no
/// times for `with_times`
void write_reference(const std::filesystem::path& results, const std::filesystem::path& reference,
                     bool with_times = false);

}  // namespace raymoval
