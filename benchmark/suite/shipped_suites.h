// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace raymoval {

/// Names of the suites that come with the program, sorted.
std::vector<std::string> shipped_suite_names();

/// The comment at the top of a shipped suite, which says what it is for. Empty if there is none.
std::string suite_sentence(const std::string& name);

/// The suite file `name_or_path` if there is such a file, else the shipped suite of that name.
/// @throws UsageError that suggests the nearest shipped name
std::filesystem::path find_suite(const std::string& name_or_path);

}  // namespace raymoval
