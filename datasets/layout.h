// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

struct SequenceSettings;

/// Where the pose of a scan stands.
enum class PosePlace {
  kOther,             ///< Anywhere else; inspection does not look for it.
  kRowOfFrameNumber,  ///< In a pose file with a row for each frame number from 0.
  kRowOfScan,         ///< In a pose file with a row for each scan, in the order of the scans.
  kScanFile,          ///< In the scan file itself: VIEWPOINT of a .pcd file.
};

/// What a layout says whose sequences are made, not read from a place that the user names.
struct SceneNames {
  std::function<std::vector<std::string>()> names;  ///< Those that the program brings along.
  /// The name that a sequence gets, told without making it. @throws UsageError, DataError
  std::function<std::string(const std::string& path)> sequence_name;
  /// What to write, or to do, to mean the scene where a folder has the same name.
  std::function<std::string(const std::string& path)> unmistakable;
  /// Whether opening it leaves nothing new on the disk, because it is there. Null if none ever
  /// does.
  std::function<bool(const std::string& path)> is_made = nullptr;
};

/// A way in: how sequences of one kind are recognised and opened, and what holds for all of them.
/// Each stands in a folder of its own and is listed in datasets/layouts.cpp.
struct Layout {
  using Path = const std::string&;

  std::string name;      ///< In results, such as "semantickitti".
  std::string expected;  ///< What is expected, for messages: "a DynamicMap sequence (pcd/*.pcd)".
  /// What a user writes to open one, with a sentence each, for `raymoval list sequences`.
  std::vector<std::pair<std::string, std::string>> forms;

  std::string
      scan_folder;  ///< The folder in a sequence that holds its scans; empty: none of its own.
  std::string calibration_file;  ///< File in a sequence with a row "Tr:"; empty if there is none.
  PosePlace pose_place = PosePlace::kOther;
  bool points_in_world = false;      ///< Whether stored points stand in the world frame.
  bool labels_in_intensity = false;  ///< Whether labels are the intensity of the stored points.
  ClassNames class_names;            ///< Of the semantic ids in its labels.
  /// What makes a sequence one with labels, for messages.
  std::string expected_labels = "a folder labels/ beside the scans";

  /// Whether `path`, as a user gives it, is of this layout. @throws DataError if it cannot be
  /// looked at
  std::function<bool(Path path)> recognise;
  /// Opens what `recognise` takes. @throws as `open_sequence`
  std::function<Sequence(Path path, const SequenceOptions&, const OpenContext&)> open;
  /// The folder of the sequence that `path` names. Null if it is `path` itself.
  std::function<std::filesystem::path(Path path)> folder_of = nullptr;
  /// Only for scenes. The name of a scene is the scene also where a folder has it.
  std::optional<SceneNames> scenes = std::nullopt;
};

/// A sequence with everything but its scans, labels and pose file filled in.
/// @param range as used, both ends set
Sequence make_sequence(const SequenceSettings& settings, const Layout& layout,
                       const FrameRange& range);

}  // namespace raymoval
