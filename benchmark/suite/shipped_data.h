// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace raymoval {

/// The folder `name` ("suites", "published") of the data that comes with the program. It is looked
/// for in ../share/raymoval, seen from the folder of an installed program, then in share/raymoval,
/// where the program was built, then where it was configured to be installed, then in
/// /usr/share/raymoval. Empty if it is in none of these.
std::filesystem::path shipped_data(const std::string& name);

/// "none of A, B, C is there. Install raymoval again."
std::string missing_data(const std::string& name);

}  // namespace raymoval
