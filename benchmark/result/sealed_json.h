// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace raymoval {

/// Text of `json` over several lines; bytes that are not UTF-8 are replaced.
std::string json_text(const nlohmann::ordered_json& json);

/// Adds "checksum", the hash of everything else, and writes the file atomically.
void write_sealed(const std::filesystem::path& path, nlohmann::ordered_json json);

/// Reads what `write_sealed` wrote.
/// @throws DataError if the file is missing, is no JSON, or does not fit its checksum
nlohmann::ordered_json read_sealed(const std::filesystem::path& path);

}  // namespace raymoval
