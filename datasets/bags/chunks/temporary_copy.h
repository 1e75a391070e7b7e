// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "core/files/scratch_folder.h"
#include "datasets/bags/chunks/bag_file.h"

namespace raymoval {

/// What a file packed by Zstandard unpacks to, in a temporary folder that goes with this object.
class TemporaryCopy {
 public:
  /// @throws DataError if the disk has no room for it, or if it unpacks to more than 1,000 times
  ///   its bytes and 1 MiB; UnreadableError if the disk fails
  explicit TemporaryCopy(const BagFile& packed);

  /// It has the name of the packed file, without the ending that says how it is packed.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// What is wrong with the packed file, such as a cut end; empty if it is whole.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  ScratchFolder folder_{kRecordingFolder};
  std::filesystem::path path_;
  std::string problem_;
};

/// "drive_0.db3" of "drive_0.db3.zstd" and of "drive_0.db3.zst"; other names as they are.
std::filesystem::path without_zstd_ending(const std::filesystem::path& name);

}  // namespace raymoval
