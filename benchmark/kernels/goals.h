// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/kernels/series.h"

namespace raymoval::kernels_bench {

/// What was aimed at beside what was measured, a row each, as a Markdown table; on the drive if
/// there is one, else on the simulated sequence.
std::string goals_table(const Results& results);

}  // namespace raymoval::kernels_bench
