// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

/// Opens a sequence by the first layout that recognises `path` (see `layouts`). `path` is one of:
/// - a sequence folder with `velodyne/` (SemanticKITTI), `pcd/` (KTH DynamicMap), or `.pcd`,
///   `.ply`, `.bin` scans beside a pose file;
/// - `ROOT:05`, the whole sequence `ROOT/sequences/05` of a SemanticKITTI root;
/// - `ROOT:kitti-05`, the segment of that sequence that papers use (kitti-00, -01, -02, -05, -07,
///   see `paper_segments`); `options.frames` replaces its frame range;
/// - `street`, the small built-in scene, made in memory;
/// - a simulated scene (see `raymoval list scenes`) or the path of a scene file, with options or
///   without: `town`, `town:scans=60,seed=3,sensor=vlp16,pose_noise=0,rolling=skewed`. `sensor` is
///   a name or path of a simulated sensor; `SimulationOptions` has the defaults. The scene is
///   generated once into the cache folder (`default_cache_root`) and read from there like any
///   other sequence in SemanticKITTI layout;
/// - a path of a layout that was added with `register_layout`.
///
/// A scene takes precedence over a folder of the same name: write `./town` for the folder, and see
/// `scene_or_folder`. A `sequence.json` in the folder may have settings, see `read_settings`;
/// `options` replace them.
/// @throws DataError, UsageError or ConfigurationError naming what was found and what was expected;
///   Cancelled
Sequence open_sequence(const std::string& path, const SequenceOptions& options,
                       const OpenContext& context = {});

/// The name that `open_sequence` would give, without generating a scene.
/// @throws as `open_sequence` if the name depends on files
std::string sequence_name(const std::string& path, const SequenceOptions& options);

/// The built-in scenes: `town` and so on, and `street`.
std::vector<std::string> scene_names();

/// Whether `open_sequence` opens `path` as a scene: `street`, a simulated scene, a scene file.
bool is_scene(const std::string& path);

/// Whether `open_sequence` writes no file: false for a scene that is not in the cache yet.
/// @throws as `open_sequence` for a scene
bool is_at_hand(const std::string& path);

/// The message for an ambiguous `path`: the name of a scene and of a folder in `base`. Empty if it
/// is not ambiguous.
/// @param base folder of the user's relative paths; empty: the current folder
std::string scene_or_folder(const std::string& path, const std::filesystem::path& base = {});

/// @throws UsageError with the text of `scene_or_folder`
void check_not_both(const std::string& path);

}  // namespace raymoval
