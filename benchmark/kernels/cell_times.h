// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/result/speed/speed_record.h"

namespace raymoval::kernels_bench {

/// Times a whole cell (load, method, score) of every registered method, with its default variant,
/// on one fixed scene, and the yardstick before each cell. It works in rounds, so that a machine
/// that slows down affects all methods. It uses one thread.
/// @throws Error if a cell fails
SpeedRecord time_cells(int rounds);

/// Markdown: the medians of each cell and of its parts.
std::string cells_table(const SpeedRecord& speed);

}  // namespace raymoval::kernels_bench
