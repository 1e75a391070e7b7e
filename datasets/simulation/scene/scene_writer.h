// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "core/progress.h"
#include "datasets/simulation/scene/simulated.h"

namespace raymoval::simulated {

/// What scene is written, and how.
struct SceneWriting {
  const SimulationOptions& options;
  std::string identity;  ///< Written into the list of files; see `scene_folder_problem`.
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;  ///< Checked before each scan.
};

/// Writes the files of a scene into `folder`, which exists and is empty; the list of them last.
/// @throws as `make_simulated`; DataError if a file cannot be written; Cancelled
void write_scene(const SceneWriting& writing, const std::filesystem::path& folder);

}  // namespace raymoval::simulated
