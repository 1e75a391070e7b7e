// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace raymoval::kernels_bench {

/// Markdown tables of medians from Google Benchmark's JSON files.
/// @throws raymoval::DataError if a file cannot be read
std::string tables_of(const std::vector<std::string>& json_files);

}  // namespace raymoval::kernels_bench
