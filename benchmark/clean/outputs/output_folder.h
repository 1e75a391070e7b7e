// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/files/part_name.h"
#include "core/files/replacements.h"

namespace raymoval {

/// A folder that is filled under a temporary name beside its final path and renamed when it is
/// complete. It takes the permissions of the folder that it replaces; its files take the
/// permissions of earlier files of the same name.
class OutputFolder {
 public:
  /// @throws DataError if the folder cannot be made
  explicit OutputFolder(const std::filesystem::path& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// The temporary folder.
  [[nodiscard]] const std::filesystem::path& place() const { return part_.place; }
  /// The final folder.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Lets `together` rename the folder, in place of an earlier one. @throws DataError
  void commit_with(Replacements& together);

 private:
  std::filesystem::path path_;
  Part part_;
  bool committed_ = false;
};

}  // namespace raymoval
