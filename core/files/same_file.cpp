// SPDX-License-Identifier: MIT
#include "core/files/same_file.h"

#include <system_error>

#include "core/files/file_kind.h"

namespace raymoval {

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (!is_there(a) || !is_there(b)) return false;
  std::error_code error;
  const bool same = std::filesystem::equivalent(a, b, error);
  if (error) {
    throw UnreadableError(a.string() + ": cannot be compared with " + b.string() + " (" +
                          error.message() + ").");
  }
  return same;
}

}  // namespace raymoval
