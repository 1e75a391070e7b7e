// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/scan/label_rule.h"
#include "core/scan/range_limits.h"
#include "core/scan/scan_source.h"
#include "datasets/clouds/frames.h"
#include "datasets/ego/ego_region.h"
#include "datasets/ego/sensor_places.h"
#include "datasets/records/record_source.h"
#include "datasets/sequence_record.h"
#include "datasets/trajectories/trajectory.h"
#include "datasets/world_axes/up_direction.h"

namespace raymoval {

class EgoFreeSource;
class FileScanSource;
class UpChoice;

/// What a user may say about a sequence. What is empty comes from the folder's sequence.json, and
/// if that does not say it either, from the layout's defaults.
struct SequenceOptions {
  std::optional<FrameRange> frames;
  /// Pose file: a name in the sequence's folder, or a path; "identity" for a sensor that stands.
  std::optional<std::string> poses;
  std::optional<std::filesystem::path> label_rule;  ///< JSON file, or `kMovingNow`.
  std::optional<RangeLimits> range_m;
  std::optional<std::string> sensor;  ///< Name of a known sensor, or "estimated" or "" for none.
  std::optional<std::string> up;      ///< Which way is up in the world, see `parse_up`.
  std::optional<EgoRegion> drop_ego;  ///< Points of the own vehicle that are left out.
  std::optional<std::string> name;    ///< Name in results.
  std::optional<std::string> topic;   ///< Topic of a bag with the scans.
  std::optional<std::string> pose_topic;    ///< Topic of a bag with the poses of these scans.
  std::optional<std::string> point_layout;  ///< Fields of .bin and .npy files, "x y z intensity".
  std::optional<PointFrame> points;         ///< The frame that points are stored in.
  std::optional<std::string> T_sensor;  ///< Sensor in the frame of the poses: a file, or 7 numbers.
  std::optional<SensorPlaces> sensor_origin;  ///< In the frame of the points.
  std::optional<double> time_offset_s;  ///< Added to the times of scans before poses are looked up.
  std::optional<double> max_gap_s;      ///< Longest time between poses that are interpolated.
  std::optional<std::string> pose_format;      ///< Name in the list of pose formats.
  std::optional<bool> deskew;                  ///< Whether motion within a scan is taken out.
  std::optional<std::string> point_time_unit;  ///< s, ms, us, ns, or a number of seconds.
  bool skip_bad_scans = false;                 ///< Scans that cannot be read are left out.
};

/// How a simulated scene is generated that is not in the cache yet.
struct OpenContext {
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  /// Whether a scene's files in the cache are compared with their hashes, besides names and sizes.
  /// This is not needed where what is loaded is compared with a fingerprint.
  bool check_content = true;
};

/// An opened sequence: where its scans and labels come from, and how they are to be read.
struct Sequence {
  std::string name;
  std::string layout;  ///< Name of its layout, as in the registry of layouts.
  std::shared_ptr<const ScanSource> scans;
  /// The scans as they were opened, where `scans` may be something that passes them on.
  std::shared_ptr<const ScanSource> opened = nullptr;
  std::shared_ptr<const LabelSource> labels;  ///< Null if the data has none.
  /// What is stored of the scans, with all fields. Null for scenes that are made in memory.
  std::shared_ptr<const RecordSource> records = nullptr;
  /// What a user should know of how it was opened, in whole sentences: the topic that was chosen.
  std::vector<std::string> notes = {};
  /// Which scans of the data are not among `scans`, though they were asked for, in whole sentences:
  /// how many have no pose or no point.
  std::vector<std::string> losses = {};
  /// If a quarter of the scans or more have no pose.
  std::optional<PoseGap> pose_gap = std::nullopt;
  /// What of a recording cannot be read, in whole sentences: that it is cut.
  std::vector<std::string> damage = {};
  /// What else was read besides the scans and their labels: pose files, times, T_sensor, settings.
  std::vector<std::filesystem::path> input_files = {};
  /// Where the sensor was over time, for the motion within a scan. Null if the times are unknown.
  std::shared_ptr<const SensorMotion> motion = nullptr;
  /// The time of each scan on the clock of `motion`. Empty if there is no motion.
  std::vector<Nanoseconds> stamps = {};
  /// Whether motion within a scan is taken out, as a user asked.
  bool deskew = false;
  std::optional<std::string> point_time_unit = std::nullopt;  ///< As a user says it.
  std::optional<std::string> T_sensor = std::nullopt;         ///< As a user says it.
  std::optional<SensorPlaces> sensor_origin = std::nullopt;   ///< As a user says it.
  std::optional<double> time_offset_s = std::nullopt;         ///< As a user says it.
  LabelRule label_rule;
  bool moving_now = false;  ///< Labels move only in scans in which what they belong to moves.
  RangeLimits range_m;
  EgoRegion drop_ego;      ///< As the user asked; `scans` leave it out (see `EgoFreeSource`).
  std::string frames;      ///< The range as used, "2350:2670:2".
  std::string poses_file;  ///< Name of the pose file, without a path.
  std::string source;      ///< Free text on origin and licence.
  std::optional<double> scan_period_s;
  /// Calibration "Tr" where the pose file has poses of a camera; the scans' poses contain it.
  std::optional<Pose> T_camera_lidar = std::nullopt;
  std::optional<Pose> T_body_sensor = std::nullopt;  ///< Of `T_sensor`, applied to the poses.
  /// Which way is up in the world of the poses. Null stands for the world's z axis.
  std::shared_ptr<const UpChoice> up_choice = nullptr;

  /// The scans as they were opened. Reading them does not count as a method's reading.
  [[nodiscard]] const ScanSource& as_opened() const { return opened ? *opened : *scans; }
  /// Which way is up. It is estimated from the scans at the first call, unless a user said it.
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

/// The source that leaves out the own vehicle of `sequence`. Null if nothing does.
const EgoFreeSource* ego_free_source(const Sequence& sequence);
/// The scans of `sequence` as they are stored, with the own vehicle.
const ScanSource& stored_source(const Sequence& sequence);
/// The files that `sequence` is read from. Null if it is not read from files.
const FileScanSource* file_source(const Sequence& sequence);

}  // namespace raymoval
