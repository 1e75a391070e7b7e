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

/// Where the pose of a scan is stored.
enum class PosePlace {
  kOther,             ///< Anywhere else; inspection cannot locate it.
  kRowOfFrameNumber,  ///< In a pose file with a row for each frame number from 0.
  kRowOfScan,         ///< In a pose file with a row for each scan, in the order of the scans.
  kScanFile,          ///< In the scan file itself: VIEWPOINT of a .pcd file.
};

/// Names of a layout whose sequences are generated, not read from a path of the user.
struct SceneNames {
  std::function<std::vector<std::string>()> names;  ///< Built-in scenes.
  /// The name of a sequence, without generating it. @throws UsageError, DataError
  std::function<std::string(const std::string& path)> sequence_name;
  /// How the user selects the scene if a folder has the same name.
  std::function<std::string(const std::string& path)> unmistakable;
  /// Whether the scene is on the disk already, so that opening it writes no file. Null if opening
  /// never writes a file.
  std::function<bool(const std::string& path)> is_made = nullptr;
};

/// A layout: how sequences of one kind are recognised and opened, and their common properties. Each
/// layout has its own source file and is listed in datasets/layouts.cpp.
struct Layout {
  using Path = const std::string&;

  std::string name;      ///< In results, such as "semantickitti".
  std::string expected;  ///< For messages: "a DynamicMap sequence (pcd/*.pcd)".
  /// Forms of paths, with a sentence each, for `raymoval list sequences`.
  std::vector<std::pair<std::string, std::string>> forms;

  std::string
      scan_folder;  ///< The folder in a sequence that holds its scans; empty: none of its own.
  std::string calibration_file;  ///< File in a sequence with a row "Tr:"; empty if there is none.
  PosePlace pose_place = PosePlace::kOther;
  bool labels_in_intensity = false;  ///< Whether labels are the intensity of the stored points.
  ClassNames class_names;            ///< Of the semantic ids in its labels.
  /// What a sequence needs to have labels, for messages.
  std::string expected_labels = "a folder labels/ beside the scans";

  /// Whether a user's `path` is of this layout. @throws DataError if it cannot be accessed
  std::function<bool(Path path)> recognise;
  /// Opens a path that `recognise` accepts. @throws as `open_sequence`
  std::function<Sequence(Path path, const SequenceOptions&, const OpenContext&)> open;
  /// The folder of the sequence that `path` names. Null if it is `path` itself.
  std::function<std::filesystem::path(Path path)> folder_of = nullptr;
  /// Only for scenes. A scene takes precedence over a folder of the same name.
  std::optional<SceneNames> scenes = std::nullopt;
};

/// A sequence without its scans, labels and pose file.
/// @param range with both ends set
Sequence make_sequence(const SequenceSettings& settings, const Layout& layout,
                       const FrameRange& range);

/// Copies the motion, notes and losses of `poses` into `sequence`, and the times of the scans that
/// have a pose.
void add_poses(const ScanPoses& poses, Sequence& sequence);

/// Removes the poses of scans whose files cannot be read (see `drop_bad_scans`).
void drop_bad_files(const std::vector<NumberedFile>& files, const RecordReading& reading,
                    const OpenContext& context, std::vector<std::optional<Pose>>& poses,
                    std::vector<std::string>& losses);

/// Sets the label file `folder`/NAME.label of each frame, and the labels of `sequence`. Its label
/// rule ignores frames whose file is missing or empty; if all are, there are no labels.
void add_label_files(const std::filesystem::path& folder, std::vector<FrameEntry>& frames,
                     Sequence& sequence);

// The layouts of datasets/, except those of SemanticKITTI and `street`.

/// Simulated scenes: generated into the cache at first use, and read like a recorded drive in
/// SemanticKITTI layout.
Layout scenes_layout();

/// Recordings of ROS messages: ROS 1 bags, MCAP, and recordings of ROS 2. The scans are the
/// messages of a topic; a scan has the number of its message, from 0, and the time of its header.
Layout bags_layout();

/// HeLiMOS ("HeLiMOS: A Dataset for Moving Object Segmentation in 3D Point Clouds From
/// Heterogeneous LiDAR Sensors", 2024): a root with one folder for each sensor, in SemanticKITTI's
/// layout
/// (`Ouster/velodyne`, `Ouster/labels`, `Ouster/calib.txt`), and train.txt, val.txt, test.txt
/// beside them. `ROOT:Ouster` names a sensor, and so does its folder.
///
/// Labels are those of moving-object segmentation: 251 and SemanticKITTI's moving classes 252 to
/// 259 move, 9 is static, and 0 (unlabelled) is ignored. The user's label rule replaces that.
Layout helimos_layout();

/// Sequences of the KTH DynamicMap benchmark: `pcd/NNNNNN.pcd` with points in the world frame, and
/// VIEWPOINT = tx ty tz qw qx qy qz as the pose of the sensor. `Scan::points` are T^-1 times the
/// stored points.
///
/// The ground truth of this data set is `gt_cloud.pcd`, a map without scans. The meaning of the
/// scans' intensity depends on the release (0 / 1 for static / moving, a raw SemanticKITTI label by
/// value, or the intensity of the return), and the files do not state it. So intensity is read as a
/// label, by value, only if a label rule is given (`labels` in sequence.json or an option, such as
/// {"moving": [1]} for clouds with 0 / 1); otherwise there are no labels. Intensity never becomes
/// reflectance, so that no method gets a label.
Layout dynamicmap_layout();

/// Plain folders of scans in the sensor frame (any of `cloud_formats`), in natural order of their
/// names, with one pose of the LiDAR for each scan in `poses.txt` or the named pose file (KITTI or
/// TUM rows). Frame numbers are positions in that order, from 0. `labels/NAME.label` is used if
/// there is such a folder. The numbers of poses and scans must be equal.
Layout files_layout();

}  // namespace raymoval
