// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "benchmark/picture/charts/charts.h"

namespace raymoval {

/// The endings of the files that a chart can be written to.
const std::vector<std::string>& chart_extensions();

/// Makes a chart as SVG for a place.
using DrawChart = std::function<std::string(ChartPlace)>;

/// Writes a chart as .svg, .pdf or .png, as the ending of `path` says. A PNG has two pixels for
/// each pixel of the chart. The file is there whole or not at all. The same chart gives the same
/// bytes on machines with the same fonts.
/// @throws DataError if it cannot be drawn or written
void write_chart(const std::filesystem::path& path, const DrawChart& draw);

}  // namespace raymoval
