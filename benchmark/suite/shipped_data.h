// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace raymoval {

/// Folder `name` ("suites", "published") of what is shipped beside the program: ../share/raymoval
/// seen from its folder where it is installed, share/raymoval where it was built, else the place it
/// was configured for. Empty if it is nowhere.
std::filesystem::path shipped_data(const std::string& name);

/// "none of A, B, C is there. Install raymoval again."
std::string missing_data(const std::string& name);

}  // namespace raymoval
