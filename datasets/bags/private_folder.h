// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/files/part_name.h"

namespace raymoval {

/// A new folder below TMPDIR (/tmp if that is not set) that only this user can enter. It goes with
/// this object, with all that is in it. A process that is killed leaves its folder behind; then its
/// lock is free (see `new_part_folder`), and `remove_abandoned_private_folders` or the next process
/// that makes such a folder removes it.
class PrivateFolder {
 public:
  /// @throws DataError if none can be made
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return part_.place; }

 private:
  Part part_;
};

/// Removes the private folders that killed processes of this user have left. It never throws.
void remove_abandoned_private_folders();

}  // namespace raymoval
