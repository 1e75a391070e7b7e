// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "core/progress.h"
#include "datasets/simulation/scene/simulated.h"

namespace raymoval::simulated {

/// Name of the file that lists all others of a folder with their sizes and hashes.
inline constexpr const char* kManifestName = "manifest.json";

/// A scene to write, and the options.
struct SceneWriting {
  const SimulationOptions& options;
  std::string identity;  ///< Written into the list of files; see `scene_folder_problem`.
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;  ///< Checked before each scan.
};

/// Writes the files of a scene into a new folder beside `target`, the list of files last, and
/// renames it to `target`, which it replaces. A folder with the list is whole, also after a power
/// failure.
/// @param is_made called when all is written: whether `target` is the scene by now, and is kept
/// @throws as `make_simulated`; DataError if a file cannot be written; Cancelled
void write_scene(const SceneWriting& writing, const std::filesystem::path& target,
                 const std::function<bool()>& is_made);

/// Why `folder` is not exactly the scene that was written as `identity`: no list, a file that is
/// missing or has another size, an extra scan. Empty if it is whole. Files that are not part of the
/// sequence are ignored.
/// @param with_content whether the files' hashes are compared too
/// @param threads used for reading
/// @throws UnreadableError (see core/files/file_kind.h)
std::string scene_folder_problem(const std::filesystem::path& folder, const std::string& identity,
                                 bool with_content, int threads);

}  // namespace raymoval::simulated
