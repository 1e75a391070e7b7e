// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/result/results.h"

namespace raymoval {

/// What a run ends with on a terminal: a row for each method, best first, with its rates (means
/// over several sequences), time and memory; the main rate of each sequence if there is room; the
/// cells that failed; whether the controls are as they must be; and how to see more. At most 100
/// characters wide, and one screen high for ten methods.
/// @param place the run folder, as the user named it
std::string run_summary(const RunResults& results, const std::string& place);

}  // namespace raymoval
