// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/result/results.h"

namespace raymoval {

/// The summary at the end of a run, for a terminal: a row for each method, best first, with its
/// rates (means over several sequences), time and memory; the main rate of each sequence if there
/// is room; failed cells; whether the controls have their expected rates; and commands that show
/// more. At most 100 characters wide, and one screen high for ten methods.
/// @param place the run folder, as the user named it
std::string run_summary(const RunResults& results, const std::string& place);

}  // namespace raymoval
