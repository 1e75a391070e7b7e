// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

/// Opens a sequence by the first layout that recognises `path` (see `layouts`). `path` is one of:
/// - a sequence folder, whose content says its layout: `velodyne/` (SemanticKITTI), `pcd/` (KTH
///   DynamicMap), or `.pcd`, `.ply`, `.bin` scans beside a pose file;
/// - `ROOT:05`, the whole sequence `ROOT/sequences/05` of a SemanticKITTI root;
/// - `ROOT:kitti-05`, the segment of that sequence which the field compares on (kitti-00, -01, -02,
///   -05, -07, see `paper_segments`); `options.frames` replaces its frame range;
/// - `street`, the small built-in scene, made in memory;
/// - a simulated scene (see `raymoval list scenes`) or the path of a scene file, with options or
///   without: `town`, `town:scans=60,seed=3,sensor=vlp16,pose_noise=0,rolling=skewed`. `sensor` is
///   a name or path of a simulated sensor; what is not given is as `SimulationOptions` says. It is
///   generated once into the cache folder (`default_cache_root`) and read from there like any
///   other sequence in SemanticKITTI layout;
/// - what a layout takes that was added with `register_layout`.
///
/// The name of a scene is the scene also where a folder has it: write `./town` for the folder, and
/// see `scene_or_folder`. A `sequence.json` in the folder may say more, see `read_settings`;
/// `options` stand above it.
/// @throws DataError, UsageError or ConfigurationError saying what was found and what was expected;
/// Cancelled
Sequence open_sequence(const std::string& path, const SequenceOptions& options,
                       const OpenContext& context = {});

/// The name that `open_sequence` would give, told without generating a scene.
/// @throws as open_sequence where more has to be looked at than the name
std::string sequence_name(const std::string& path, const SequenceOptions& options);

/// The scenes that the program brings along: `town` and so on, and `street`.
std::vector<std::string> scene_names();

/// Whether `open_sequence` takes `path` for a scene: `street`, a simulated one, a scene file.
bool is_scene(const std::string& path);

/// Whether `open_sequence` would leave nothing new on the disk: false for a scene that it would
/// simulate into the cache first. @throws as open_sequence for a scene
bool is_at_hand(const std::string& path);

/// What to tell a user who may mean either: `path` names a scene, and a folder of that name stands
/// in `base`. Empty if only one is there.
/// @param base folder that the user's paths start from; empty: the current one
std::string scene_or_folder(const std::string& path, const std::filesystem::path& base = {});

/// @throws UsageError with the text of `scene_or_folder`
void check_not_both(const std::string& path);

}  // namespace raymoval
