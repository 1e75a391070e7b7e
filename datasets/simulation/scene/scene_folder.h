// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>

namespace raymoval::simulated {

/// Name of the file that lists all others of a folder with their sizes and hashes.
inline constexpr const char* kManifestName = "manifest.json";

/// Writes the files of a new folder and, last, the list of them: a folder with the list is whole,
/// also after a power failure. Members throw DataError naming the path and the system's reason.
class SceneFolder {
 public:
  /// @param folder exists and is empty
  explicit SceneFolder(std::filesystem::path folder);
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  /// Writes a file and puts it on the disk. Thread-safe.
  /// @param name relative to the folder, below velodyne/ or labels/ or in the folder itself
  void write(const std::string& name, const void* data, std::size_t size);
  void write(const std::string& name, const std::string& text);

  /// Writes the list and puts the names of all files on the disk.
  /// @param identity of what the folder holds; see `scene_folder_problem`
  void finish(const std::string& identity);

 private:
  struct Entry {
    std::size_t bytes = 0;
    std::string hash;
  };
  std::filesystem::path folder_;
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

/// What keeps `folder` from being all that was once written there as `identity`: no list, a file
/// that is missing or has another size, a scan too many. Empty if it is whole. Files that nobody
/// reads as part of the sequence do not count.
/// @param with_content whether the files' hashes are compared too
/// @param threads used for reading
/// @throws UnreadableError (see core/files/file_kind.h)
std::string scene_folder_problem(const std::filesystem::path& folder, const std::string& identity,
                                 bool with_content, int threads);

}  // namespace raymoval::simulated
