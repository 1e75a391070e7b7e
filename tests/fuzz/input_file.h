// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace raymoval::fuzz {

/// Writes `bytes` to the file `name` of this process's own folder, in memory where the system has
/// such a place, and gives its path. Every call with the same name replaces the file.
std::filesystem::path input_file(const std::string& name, std::string_view bytes);

}  // namespace raymoval::fuzz
