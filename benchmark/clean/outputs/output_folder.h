// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/files/part_name.h"
#include "core/files/replacements.h"

namespace raymoval {

/// A folder that is filled under another name beside its own, and gets its name when it is
/// complete. It takes the rights of the folder that it replaces, and files in it those of the files
/// that had their names.
class OutputFolder {
 public:
  /// Makes it. @throws DataError if that cannot be done
  explicit OutputFolder(const std::filesystem::path& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where it is being filled.
  [[nodiscard]] const std::filesystem::path& place() const { return part_.place; }
  /// Where it will be.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Lets `together` give it its name, in place of a folder that had it. @throws DataError
  void commit_with(Replacements& together);

 private:
  std::filesystem::path path_;
  Part part_;
  bool committed_ = false;
};

}  // namespace raymoval
