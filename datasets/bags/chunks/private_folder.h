// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace raymoval {

/// A folder below TMPDIR (/tmp if that is not set) that only this user can enter. It goes with this
/// object, with all that is in it.
class PrivateFolder {
 public:
  /// @throws DataError if none can be made
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace raymoval
