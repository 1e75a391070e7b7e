// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
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

/// The user's options for a sequence. Empty values come from the folder's sequence.json, else from
/// the layout's defaults.
struct SequenceOptions {
  std::optional<FrameRange> frames;
  /// Pose file: a name in the sequence's folder, or a path; "identity" for a stationary sensor.
  std::optional<std::string> poses;
  std::optional<std::filesystem::path> label_rule;  ///< JSON file, or `kMovingNow`.
  std::optional<RangeLimits> range_m;
  std::optional<std::string> sensor;  ///< Name of a known sensor, or "estimated" or "" for none.
  std::optional<std::string> up;      ///< Up direction in the world, see `parse_up`.
  std::optional<EgoRegion> drop_ego;  ///< Points of the ego vehicle that are left out.
  std::optional<std::string> name;    ///< Name in results.
  std::optional<std::string> topic;   ///< Topic of a bag with the scans, or several with commas.
  std::optional<std::string> pose_topic;    ///< Topic of a bag with the poses of these scans.
  std::optional<std::string> point_layout;  ///< Fields of .bin and .npy files, "x y z intensity".
  std::optional<PointFrame> points;         ///< The frame that points are stored in.
  std::optional<std::string> T_sensor;  ///< Sensor in the frame of the poses: a file, or 7 numbers.
  std::optional<SensorPlaces> sensor_origin;  ///< In the frame of the points.
  std::optional<double> time_offset_s;  ///< Added to the times of scans before poses are looked up.
  std::optional<double> max_gap_s;      ///< Longest time between poses that are interpolated.
  std::optional<std::string> pose_format;      ///< Name in the list of pose formats.
  std::optional<bool> deskew;                  ///< Whether motion within a scan is corrected.
  std::optional<std::string> point_time_unit;  ///< s, ms, us, ns, or a number of seconds.
  bool skip_bad_scans = false;                 ///< Scans that cannot be read are left out.
};

/// How to generate a simulated scene that is not in the cache yet.
struct OpenContext {
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
};

/// An opened sequence: the sources of its scans and labels, and how to read them.
struct Sequence {
  std::string name;
  std::string layout;  ///< Name of its layout, as in the registry of layouts.
  std::shared_ptr<const ScanSource> scans;
  /// The scans as opened; `scans` may wrap them.
  std::shared_ptr<const ScanSource> opened = nullptr;
  std::shared_ptr<const LabelSource> labels;  ///< Null if the data has none.
  /// The records of the scans, with all fields. Null for scenes that are made in memory.
  std::shared_ptr<const RecordSource> records = nullptr;
  /// Notes for the user on how it was opened, in whole sentences, such as the chosen topic.
  std::vector<std::string> notes = {};
  /// Requested scans that are missing in `scans`, in whole sentences, such as the number of scans
  /// without a pose or a point.
  std::vector<std::string> losses = {};
  /// Set if a quarter of the scans or more have no pose.
  std::optional<PoseGap> pose_gap = std::nullopt;
  /// Unreadable parts of a recording, in whole sentences, such as a truncated end.
  std::vector<std::string> damage = {};
  /// Files that were read other than scans and labels: pose files, times, T_sensor, settings.
  std::vector<std::filesystem::path> input_files = {};
  /// The motion of the sensor, to correct motion within a scan; of several topics, the motion of
  /// the first one's sensor. Null if the times are unknown.
  std::shared_ptr<const SensorMotion> motion = nullptr;
  /// The time of each scan on the clock of `motion`. Empty if there is no motion.
  std::vector<Nanoseconds> stamps = {};
  /// The topic of each scan, as its position in --topic. Empty unless several topics are read.
  std::vector<std::size_t> topics = {};
  /// Whether the user requested to correct motion within a scan.
  bool deskew = false;
  std::optional<std::string> point_time_unit = std::nullopt;  ///< As the user gave it.
  std::optional<std::string> T_sensor = std::nullopt;         ///< As the user gave it.
  std::optional<SensorPlaces> sensor_origin = std::nullopt;   ///< As the user gave it.
  std::optional<double> time_offset_s = std::nullopt;         ///< As the user gave it.
  LabelRule label_rule;
  bool moving_now = false;  ///< Labels move only in scans in which their object moves.
  RangeLimits range_m;
  EgoRegion drop_ego;      ///< As the user gave it; left out of `scans` (see `EgoFreeSource`).
  std::string frames;      ///< The range as used, "2350:2670:2".
  std::string poses_file;  ///< Name of the pose file, without a path.
  /// Estimated or refined poses of the frame of the stored points; empty: the poses are the user's.
  std::vector<Pose> made_poses = {};
  /// Reasons why `made_poses` may be wrong, each as a clause.
  std::vector<std::string> pose_doubts = {};
  std::string source;  ///< Free text on origin and licence.
  std::optional<double> scan_period_s;
  /// Calibration "Tr" if the pose file has poses of a camera; the scans' poses contain it.
  std::optional<Pose> T_camera_lidar = std::nullopt;
  std::optional<Pose> T_body_sensor = std::nullopt;  ///< Of `T_sensor`, applied to the poses.
  /// Names and positions of frames that are fixed to the frame of the points, metres: the tf of a
  /// recording. Reads them at each call. Null: the data has none.
  std::function<std::map<std::string, Eigen::Vector3d>()> fixed_frames = nullptr;
  /// The up direction in the world of the poses. Null: the world's z axis.
  std::shared_ptr<const UpChoice> up_choice = nullptr;

  /// The scans as opened. Reading them does not count as a method's reading.
  [[nodiscard]] const ScanSource& as_opened() const { return opened ? *opened : *scans; }
  /// The up direction. Unless the user gave it, the first call estimates it from the scans.
  /// @throws DataError if a scan cannot be read
  [[nodiscard]] UpDirection up() const;
  /// T_local_world of the frame that methods run in: the first scan's position is its origin, and
  /// its z axis points up (see `method_frame`). @throws DataError as `up`
  [[nodiscard]] Pose method_frame() const;
  /// The rotation of the world about its origin that maps up to z. @throws DataError as `up`
  [[nodiscard]] Pose upright_frame() const;
  /// The description of the sequence for results. The fingerprint is empty, because it needs all
  /// data. @throws DataError as `up`
  [[nodiscard]] DataRecord record() const;
};

/// The source that leaves out the ego vehicle of `sequence`; null if there is none.
const EgoFreeSource* ego_free_source(const Sequence& sequence);
/// The scans of `sequence` as stored, with the ego vehicle.
const ScanSource& stored_source(const Sequence& sequence);
/// The files that `sequence` is read from. Null if it is not read from files.
const FileScanSource* file_source(const Sequence& sequence);

}  // namespace raymoval
