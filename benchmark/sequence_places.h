// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "benchmark/suite.h"

namespace raymoval {

/// Where a sequence is and how it is read, as JSON, and back.
/// @throws nlohmann::json::exception, UsageError
nlohmann::ordered_json place_record(const SequenceRequest& place);
SequenceRequest place_from(const nlohmann::ordered_json& record);

/// Writes sources.json: where the sequences of a run were read from, with absolute paths. Apart
/// from run.json, since results are the same wherever the data lies.
/// @param sequences as opened, one for each of `places`
void write_sources(const std::filesystem::path& run, const std::vector<SequenceRequest>& places,
                   const std::vector<Sequence>& sequences);

/// What `write_sources` wrote, by name of the sequence; nothing if the file is not there.
/// @throws DataError if it is damaged
std::map<std::string, SequenceRequest> read_sources(const std::filesystem::path& run);

}  // namespace raymoval
