// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "benchmark/results.h"
#include "benchmark/text_table.h"

namespace raymoval {

/// The PR-RR curve (or SA-DA) of each swept method by each protocol: a row for each point of the
/// sweep, the sequences and their mean side by side, the best F1 (or HA) of each marked.
std::vector<TextTable> sweep_tables(const RunResults& results);

}  // namespace raymoval
