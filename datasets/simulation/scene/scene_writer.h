// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "core/progress.h"
#include "datasets/simulation/scene/simulated.h"

namespace raymoval::simulated {

/// Name of the file that marks a whole folder of a scene.
inline constexpr const char* kManifestName = "manifest.json";

/// A scene to write, and the options.
struct SceneWriting {
  const SimulationOptions& options;
  std::string identity;  ///< Written into the mark; see `scene_folder_problem`.
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;  ///< Checked before each scan.
};

/// Writes the files of a scene into a new folder beside `target`, its mark last, and
/// renames it to `target`, which it replaces. A folder with the mark is whole, also after a power
/// failure.
/// @param is_made called when all is written: whether `target` is the scene by now, and is kept
/// @throws as `make_simulated`; DataError if a file cannot be written; Cancelled
void write_scene(const SceneWriting& writing, const std::filesystem::path& target,
                 const std::function<bool()>& is_made);

/// Why `folder` is not the scene that was written as `identity`: no mark, a missing file, or
/// another number of scans. Empty if it is. Contents are not compared.
/// @throws UnreadableError (see core/files/file_kind.h)
std::string scene_folder_problem(const std::filesystem::path& folder, const std::string& identity,
                                 std::size_t scans);

}  // namespace raymoval::simulated
