// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/picture/charts/chart_drawing.h"

namespace raymoval {

/// The endings of the files that a chart can be written to.
const std::vector<std::string>& chart_extensions();

/// Writes a chart as .svg, .pdf or .png, as the ending of `path` says. A PNG has two pixels for
/// each pixel of the chart. The file is there whole or not at all. The same chart gives the same
/// bytes on machines with the same font.
/// @throws DataError if it cannot be drawn or written
/// @throws ConfigurationError if a PDF or PNG lacks its font
void write_chart(const std::filesystem::path& path, const ChartDrawing& chart);

}  // namespace raymoval
