// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/scan/label_rule.h"
#include "core/scan/range_limits.h"
#include "core/scan/scan_source.h"
#include "datasets/ego/ego_region.h"
#include "datasets/sequence_record.h"
#include "datasets/world_axes/up_direction.h"

namespace raymoval {

/// `FIRST:LAST:STRIDE` over frame numbers, ends included; any part may be empty (`::2`).
struct FrameRange {
  std::optional<long> first;
  std::optional<long> last;
  long stride = 1;
};

/// @throws UsageError saying what the form is.
FrameRange parse_frame_range(const std::string& text);
std::string frame_range_text(const FrameRange& range);

/// What a user may say about a sequence; whatever is empty comes from the folder's sequence.json,
/// else from the data set's defaults.
struct SequenceOptions {
  std::optional<FrameRange> frames;
  std::optional<std::string> poses;                 ///< Pose file, a name in the folder or a path.
  std::optional<std::filesystem::path> label_rule;  ///< JSON file.
  std::optional<RangeLimits> range_m;
  std::optional<std::string> sensor;  ///< Name of a known sensor, or "estimated" or "" for none.
  std::optional<std::string> up;      ///< Which way is up in the world, see `parse_up`.
  std::optional<EgoRegion> drop_ego;  ///< Points of the own vehicle that are left out.
  std::optional<std::string> name;    ///< Name in results.
};

/// An opened sequence: where its scans and labels come from and how they are to be read.
struct Sequence {
  std::string name;
  std::string layout;  ///< "semantickitti", "dynamicmap", "files", "simulated".
  std::shared_ptr<const ScanSource> scans;
  /// The scans as they were opened, where `scans` may be something that passes them on.
  std::shared_ptr<const ScanSource> opened = nullptr;
  std::shared_ptr<const LabelSource> labels;  ///< Null if the data has none.
  LabelRule label_rule;
  RangeLimits range_m;
  EgoRegion drop_ego;      ///< As asked for; `scans` leave it out (see `EgoFreeSource`).
  std::string frames;      ///< Range as used, "2350:2670:2".
  std::string poses_file;  ///< Name of the pose file, without a path.
  std::string source;      ///< Free text on origin and licence.
  std::optional<double> scan_period_s;
  /// Calibration "Tr" where the pose file has poses of a camera; the scans' poses contain it.
  std::optional<Pose> T_camera_lidar = std::nullopt;
  /// Which way is up in the world of the poses; null: its z axis.
  std::shared_ptr<const UpChoice> up_choice = nullptr;

  /// Which way is up; estimated from the scans when first asked for, unless a user said it.
  /// @throws DataError if a scan cannot be read
  [[nodiscard]] UpDirection up() const;
  /// T_local_world of the frame that methods run in: the first scan's position is its origin, and
  /// its z axis points up (see `method_frame`). @throws DataError as `up`
  [[nodiscard]] Pose method_frame() const;
  /// The turn of the world that brings up to z, about its origin. @throws DataError as `up`
  [[nodiscard]] Pose upright_frame() const;
  /// What is stored of the sequence with results. The fingerprint is left empty, because it takes
  /// reading all data. @throws DataError as `up`
  [[nodiscard]] DataRecord record() const;
};

/// With what a simulated scene is generated that is not in the cache yet.
struct OpenContext {
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  /// Whether a scene's files in the cache are compared with their hashes, besides names and sizes.
  /// Not needed where what is loaded is compared with a fingerprint.
  bool check_content = true;
};

/// Opens a sequence. `path` is one of:
/// - a sequence folder, its layout told by what is in it: `velodyne/` (SemanticKITTI), `pcd/` (KTH
///   DynamicMap), or `.pcd`, `.ply`, `.bin` scans beside a pose file;
/// - `ROOT:05`, the whole sequence `ROOT/sequences/05` of a SemanticKITTI root;
/// - `ROOT:kitti-05`, the segment of that sequence which the field compares on (kitti-00, -01, -02,
///   -05, -07, see `paper_segments`); `options.frames` replaces its frame range;
/// - `street`, the small built-in scene, made in memory;
/// - a simulated scene (see `raymoval list scenes`) or the path of a scene file, with options or
///   without: `town`, `town:scans=60,seed=3,sensor=vlp16,pose_noise=0,rolling=skewed`. `sensor` is
///   a name or path of a simulated sensor; what is not given is as `SimulationOptions` says. It is
///   generated once into the cache folder (`default_cache_root`) and read from there like any
///   other sequence in SemanticKITTI layout.
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

/// Whether `open_sequence` takes `path` for a scene: `street`, a simulated one, a scene file.
bool is_scene(const std::string& path);

/// What to tell a user who may mean either: `path` names a scene, and a folder of that name stands
/// in `base`. Empty if only one is there.
/// @param base folder that the user's paths start from; empty: the current one
std::string scene_or_folder(const std::string& path, const std::filesystem::path& base = {});

/// @throws UsageError with the text of `scene_or_folder`
void check_not_both(const std::string& path);

/// Hash of everything a method or protocol reads: points, reflectance, times, poses and labels of
/// the chosen frames, sensor model, label rule, range limits, and up where it is not the world's z.
/// File and sequence names are left out: a copy of the data elsewhere has the same fingerprint.
/// @param threads used for reading; the answer does not depend on it
std::string fingerprint(const Sequence& sequence, int threads);

}  // namespace raymoval
