// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace raymoval {

/// Whether two paths name one file or folder, links followed; what is absent is none.
/// @throws UnreadableError if that cannot be told; DataError as file_kind
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace raymoval
