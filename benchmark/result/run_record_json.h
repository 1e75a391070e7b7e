// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "benchmark/result/run_record.h"

namespace raymoval {

/// Reads a sealed run.json. @throws DataError if it is missing, damaged or of another version
RunRecord read_run_record(const std::filesystem::path& file);
void write_run_record(const std::filesystem::path& file, const RunRecord& run);

/// Reads a sealed results.json. @throws DataError as `read_run_record`
ResultsRecord read_results(const std::filesystem::path& file);
void write_results(const std::filesystem::path& file, const ResultsRecord& results);

/// The content of results.json as in the file, without its checksum.
/// @throws DataError as `read_results`
std::string read_results_text(const std::filesystem::path& file);

}  // namespace raymoval
