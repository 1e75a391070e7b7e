// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "benchmark/history/history.h"
#include "benchmark/tables/text/text_table.h"

namespace raymoval {

/// A table for each scene and machine, with a block for each method and a row for each commit at
/// which something changed.
/// @param all whether commits at which nothing changed have a row too
std::vector<TextTable> history_tables(const std::vector<HistoryTrack>& tracks, double band,
                                      bool all);

}  // namespace raymoval
