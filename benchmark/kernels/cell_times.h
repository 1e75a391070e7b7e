// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/result/speed/speed_record.h"

namespace raymoval::kernels_bench {

/// Times a whole cell (load, method, score) of every registered method by its default on one fixed
/// scene, and the yardstick before each of them, in rounds: a machine that slows down slows all of
/// them. One thread does everything.
/// @throws Error if a cell fails
SpeedRecord time_cells(int rounds);

/// Markdown: the medians of each cell and of its parts.
std::string cells_table(const SpeedRecord& speed);

}  // namespace raymoval::kernels_bench
