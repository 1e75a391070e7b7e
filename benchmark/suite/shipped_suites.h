// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace raymoval {

/// The folder `name` ("suites", "published") of the data that comes with the program. It is
/// searched for in ../share/raymoval relative to the folder of an installed program, in
/// share/raymoval of the build folder, below the configured install prefix, then in
/// /usr/share/raymoval. Empty if it is in none of these.
std::filesystem::path shipped_data(const std::string& name);

/// "none of A, B, C is there. Install raymoval again."
std::string missing_data(const std::string& name);

/// Names of the suites that come with the program, sorted.
std::vector<std::string> shipped_suite_names();

/// The comment at the top of a shipped suite, which describes its purpose. Empty if there is none.
std::string suite_sentence(const std::string& name);

/// The suite file `name_or_path` if there is such a file, else the shipped suite of that name.
/// @throws UsageError that suggests the nearest shipped name
std::filesystem::path find_suite(const std::string& name_or_path);

}  // namespace raymoval
