// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/clouds/file_source.h"
#include "datasets/sequence.h"
#include "datasets/trajectories/scan_poses.h"

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
/// Each stands in a file of its own and is listed in datasets/layouts.cpp.
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

/// Copies the motion, notes and losses of `poses` into `sequence`, and the times of the scans that
/// have a pose.
void add_poses(const ScanPoses& poses, Sequence& sequence);

/// Takes the poses of scans whose files cannot be read away (see `drop_bad_scans`).
void drop_bad_files(const std::vector<NumberedFile>& files, const RecordReading& reading,
                    const OpenContext& context, std::vector<std::optional<Pose>>& poses,
                    std::vector<std::string>& losses);

/// Gives each frame its label file `folder`/NAME.label, and `sequence` these labels. Frames without
/// one, or with an empty one, are ignored by its label rule; if all are, there are no labels.
void add_label_files(const std::filesystem::path& folder, std::vector<FrameEntry>& frames,
                     Sequence& sequence);

// The layouts of this room besides those of SemanticKITTI and `street`.

/// Simulated scenes: each is generated into the cache unless it is there, and then read like a
/// recorded drive in SemanticKITTI layout.
Layout scenes_layout();

/// Recordings of ROS messages: ROS 1 bags, MCAP, and what ROS 2 records. The scans are the messages
/// of a topic; a scan's number is that of its message, from 0. Their times are those in their
/// headers.
Layout bags_layout();

/// HeLiMOS ("HeLiMOS: A Dataset for Moving Object Segmentation in 3D Point Clouds From
/// Heterogeneous LiDAR Sensors", 2024): a root with one folder for each sensor, in SemanticKITTI's
/// layout
/// (`Ouster/velodyne`, `Ouster/labels`, `Ouster/calib.txt`), and train.txt, val.txt, test.txt
/// beside them. `ROOT:Ouster` names a sensor, and so does its folder.
///
/// Labels are those of moving-object segmentation: 251 moves, as do SemanticKITTI's moving classes
/// 252 to 259, 9 does not, and 0, which nobody labelled, is ignored. A label rule that the user
/// gives stands above that.
Layout helimos_layout();

/// Sequences of the KTH DynamicMap benchmark: `pcd/NNNNNN.pcd`, whose points stand in the world
/// frame, and whose VIEWPOINT = tx ty tz qw qx qy qz is the pose of the sensor. `Scan::points` are
/// T^-1 times the stored points.
///
/// The ground truth of this data set is `gt_cloud.pcd`, a map without scans. The intensity
/// of the scans means different things in different releases (0 / 1 for static / moving, a raw
/// SemanticKITTI label by value, or the strength of the return), and the files do not say which.
/// So it is not guessed: intensity is read as a label, by value, only where a label rule is given
/// (`labels` in sequence.json or an option, such as {"moving": [1]} for clouds with 0 / 1);
/// otherwise there are no labels. Intensity never becomes reflectance, so that no method can see
/// a label.
Layout dynamicmap_layout();

/// Plain folders of scans in the sensor frame (any of `cloud_formats`), in natural order of their
/// names, with one pose of the LiDAR for each scan in `poses.txt` or the pose file named (KITTI or
/// TUM rows). Frame numbers are positions in that order, from 0. `labels/NAME.label` is used if
/// there is such a folder. The counts of poses and scans have to be equal.
Layout files_layout();

}  // namespace raymoval
