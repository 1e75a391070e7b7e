// SPDX-License-Identifier: MIT
#include "datasets/semantickitti/semantickitti.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files/fields.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/scan/scan_source.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"
#include "datasets/clouds/frames.h"
#include "datasets/clouds/poses.h"
#include "datasets/settings.h"
#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/stamps.h"

namespace raymoval {
namespace {

/// The side file of a simulated scene with the times at which each mover moves.
inline constexpr const char* kMoversFile = "movers.json";

/// The static label of a moving label; other labels are unchanged.
std::uint16_t static_id(std::uint16_t id) {
  static const std::map<std::uint16_t, std::uint16_t> ids = {
      {252, 10}, {253, 31}, {254, 30}, {255, 32}, {256, 16}, {257, 13}, {258, 18}, {259, 20}};
  const auto found = ids.find(id);
  return found == ids.end() ? id : found->second;
}

/// The frame from which an instance moves, or is stationary.
struct Change {
  long frame = 0;
  bool moves = false;
};
/// Changes by instance, in order of frames.
using Motions = std::map<std::uint16_t, std::vector<Change>>;

std::vector<Change> changes_of(const Fields& mover) {
  constexpr int kMostFrames = 100'000'000;
  std::vector<Change> changes;
  for (const auto& [item, where] : mover.list("when")) {
    const Fields change(*item, where, "scan time_s state at");
    (void)change.member("scan");
    const int frame = change.integer("scan", 0, 0, kMostFrames);
    if (!changes.empty() && frame <= changes.back().frame) {
      change.fail("scan", "a later scan than that of the change before");
    }
    changes.push_back({frame, change.choice("state", "", {"moves", "stands", "away"}) == "moves"});
  }
  return changes;
}

Motions read_motions(const std::filesystem::path& file) {
  if (!has_file(file)) {
    throw DataError(file.string() +
                    ": is missing; it lists which objects move at which time, which --label-rule "
                    "moving-now needs. Simulated scenes have it. Labels of other data have no such "
                    "times: leave the rule out.");
  }
  const nlohmann::json whole = {{"movers", read_json(file)}};
  const Fields list(whole, file.string(), "movers");
  Motions motions;
  for (const auto& [item, where] : list.list("movers")) {
    const Fields mover(*item, where, "instance label kind moves when");
    (void)mover.member("instance");
    const auto instance = static_cast<std::uint16_t>(mover.integer("instance", 0, 0, 0xFFFF));
    if (!motions.emplace(instance, changes_of(mover)).second) {
      mover.fail("instance", "one that no other mover has");
    }
  }
  return motions;
}

class MovingNowLabels : public LabelSource {
 public:
  MovingNowLabels(std::shared_ptr<const LabelSource> labels, Motions motions,
                  std::vector<long> frames)
      : labels_(std::move(labels)), motions_(std::move(motions)), frames_(std::move(frames)) {}

  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    std::vector<std::uint32_t> words = labels_->labels(scan);
    const std::vector<std::uint8_t> stands = standing(frames_.at(scan.index));
    for (std::uint32_t& word : words) {
      if (stands[word >> 16U] != 0) word = (word & 0xFFFF0000U) | static_id(semantic_id(word));
    }
    return words;
  }

 private:
  /// For each instance, whether it is stationary in a frame.
  [[nodiscard]] std::vector<std::uint8_t> standing(long frame) const {
    std::vector<std::uint8_t> stands(0x10000, 0);
    for (const auto& [instance, changes] : motions_) {
      const auto next =
          std::upper_bound(changes.begin(), changes.end(), frame,
                           [](long at, const Change& change) { return at < change.frame; });
      if (next != changes.begin() && !(next - 1)->moves) stands[instance] = 1;
    }
    return stands;
  }

  std::shared_ptr<const LabelSource> labels_;
  Motions motions_;
  std::vector<long> frames_;
};

/// `labels` in which only objects that move at the time of the scan have a moving label. An object
/// that is stationary then has the static label of its class ("car" for "moving-car") and keeps its
/// instance. Labels of instances that are not in `file` are unchanged.
/// @param file `kMoversFile` of the sequence
/// @param frames number of the frame of each scan
/// @throws DataError if `file` is absent or cannot be read; ConfigurationError for a damaged one
std::shared_ptr<const LabelSource> moving_now_labels(std::shared_ptr<const LabelSource> labels,
                                                     const std::filesystem::path& file,
                                                     std::vector<long> frames) {
  return std::make_shared<MovingNowLabels>(std::move(labels), read_motions(file),
                                           std::move(frames));
}

/// Refuses too few rows: then file and scans do not belong together, and no row can be trusted. A
/// surplus of rows is normal (frames absent from the disk).
void check_row_count(std::size_t rows, const char* what, const std::filesystem::path& path,
                     const std::vector<NumberedFile>& files) {
  const long highest = files.back().number;
  if (rows > static_cast<std::size_t>(highest)) return;
  throw DataError(path.string() + ": holds " + grouped_text(rows) + " " + what + ", but the " +
                  grouped_text(files.size()) + " scans go up to frame " + std::to_string(highest) +
                  "; expected a row per frame number from 0, at least " +
                  grouped_text(static_cast<std::uint64_t>(highest) + 1) +
                  ". Take the file that belongs to these scans.");
}

/// `Tr`, LiDAR to camera; none if the poses are those of the LiDAR.
std::optional<Pose> camera_calibration(const std::filesystem::path& folder,
                                       const SequenceSettings& settings) {
  if (settings.poses_are_lidar) return std::nullopt;
  const auto calibration = folder / "calib.txt";
  if (!has_file(calibration)) {
    throw DataError(calibration.string() +
                    ": is missing; its row 'Tr:' transforms camera poses to the LiDAR (T = Tr^-1 P "
                    "Tr). Add it, or set \"poses_are_lidar\": true in sequence.json if the poses "
                    "are those of the LiDAR.");
  }
  return read_calibration(calibration, "Tr");
}

/// times.txt: the time of each frame, by frame number; empty if there is no such file.
StampColumn frame_stamps(const std::filesystem::path& folder,
                         const std::vector<NumberedFile>& files,
                         std::vector<std::filesystem::path>& input_files) {
  const auto path = folder / "times.txt";
  if (!has_file(path)) return {};
  input_files.push_back(path);
  StampColumn column = read_stamp_file(path);
  check_row_count(column.stamps.size(), "times", path, files);
  return column;
}

ScanKeys scan_keys(const std::vector<NumberedFile>& files, const std::vector<NumberedFile>& chosen,
                   const StampColumn& times, double period_s) {
  ScanKeys keys;
  keys.row_count = static_cast<std::size_t>(files.back().number) + 1;
  keys.more_rows = true;
  keys.extent =
      counted_text(files.size(), "scan") + " up to frame " + std::to_string(files.back().number);
  for (const NumberedFile& file : chosen) {
    keys.add(static_cast<std::size_t>(file.number), times, period_s);
  }
  return keys;
}

/// Frames with their poses. Frames without a pose are left out.
std::vector<FrameEntry> frame_entries(const std::vector<NumberedFile>& chosen,
                                      const ScanPoses& poses, const RecordReading& reading) {
  std::vector<FrameEntry> frames;
  std::vector<std::filesystem::path> scans;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!poses.poses[i]) continue;
    const std::filesystem::path& path = chosen[i].path;
    check_bin_size(path, plain_file_size(path), reading);
    scans.push_back(path);
    frames.push_back({path, "", path.stem().string(), poses.times_s[i], *poses.poses[i]});
  }
  check_bin_width(scans, reading);
  return frames;
}

/// The numbers of the frames that have a pose.
std::vector<long> frame_numbers(const ChosenFrames& chosen, const ScanPoses& poses) {
  std::vector<long> numbers;
  for (std::size_t i = 0; i < chosen.files.size(); ++i) {
    if (poses.poses[i]) numbers.push_back(chosen.files[i].number);
  }
  return numbers;
}

/// "0:3:2" of the existing frames; empty if no range matches them exactly.
std::string whole_range_text(const std::vector<NumberedFile>& files) {
  const long first = files.front().number;
  const long last = files.back().number;
  const long stride = files.size() > 1 ? files[1].number - first : 1;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (files[i].number != first + static_cast<long>(i) * stride) return "";
  }
  const std::string text = std::to_string(first) + ":" + std::to_string(last);
  return stride == 1 ? text : text + ":" + std::to_string(stride);
}

/// The message for data that lacks frames of a segment.
std::string lacks_frames_text(const std::filesystem::path& folder, const std::string& segment,
                              const FrameRange& frames, const std::vector<NumberedFile>& files) {
  const std::string part = whole_range_text(files);
  return folder.string() + ": segment " + segment + " is frames " + frame_range_text(frames) +
         ", but the data has " + frame_extent_text(files) +
         ". Copy the missing ones, or name your own part: --sequence " +
         folder.parent_path().parent_path().string() + ":" + folder.filename().string() +
         (part.empty() ? "" : " --frames " + part) + ".";
}

/// @param segment whose frames these are, for messages; empty if the user gave frames
ChosenFrames chosen_frames(const std::vector<NumberedFile>& files, const FrameRange& frames,
                           const std::filesystem::path& folder, const std::string& segment) {
  try {
    return choose_frames(files, frames, folder.string());
  } catch (const DataError&) {
    if (segment.empty()) throw;
    throw DataError(lacks_frames_text(folder, segment, frames, files));
  }
}

/// The poses of the chosen frames; `sequence` gets notes on them.
ScanPoses frame_poses(const std::filesystem::path& folder, const SequenceSettings& settings,
                      const ScanKeys& keys, Sequence& sequence) {
  PoseSettings options = pose_settings(settings, folder, sequence.input_files);
  sequence.T_body_sensor = options.T_body_sensor;
  sequence.poses_file = kStationarySensor;
  if (settings.poses == kStationarySensor) return stationary_poses(keys, options);
  const auto path = find_pose_file(folder, settings.poses);
  sequence.poses_file = path.filename().string();
  sequence.input_files.push_back(path);
  const PoseFile file = read_pose_file(path, {settings.pose_format});
  // With T_sensor, the poses are not those of the camera of calib.txt.
  if (!settings.T_sensor && !file.of_sensor)
    sequence.T_camera_lidar = camera_calibration(folder, settings);
  if (sequence.T_camera_lidar) {
    sequence.input_files.push_back(folder / "calib.txt");
    options.T_camera_lidar = sequence.T_camera_lidar;
  }
  return scan_poses(file, keys, options);
}

}  // namespace

Sequence open_semantickitti(const std::filesystem::path& folder, const SequenceOptions& options,
                            const OpenContext& context, const SemanticKittiDefaults& defaults) {
  SequenceSettings base;
  base.name = defaults.name;
  base.frames = defaults.frames;
  base.label_rule = defaults.label_rule;
  base.scan_period_s = kUsualScanPeriod;  // KITTI's HDL-64E turns at 10 Hz.
  const SequenceSettings settings = read_settings(folder, options, base);

  const auto files = list_numbered_files(folder / "velodyne", ".bin");
  const ChosenFrames chosen =
      chosen_frames(files, settings.frames, folder, options.frames ? "" : defaults.name);
  Sequence sequence = make_sequence(settings, semantickitti_layout(), chosen.range);
  const StampColumn times = frame_stamps(folder, files, sequence.input_files);
  const ScanKeys keys = scan_keys(files, chosen.files, times, *settings.scan_period_s);
  ScanPoses poses = frame_poses(folder, settings, keys, sequence);
  if (settings.skip_bad_scans) {
    drop_bad_files(chosen.files, {settings.point_layout}, context, poses.poses, poses.losses);
  }

  std::vector<FrameEntry> entries = frame_entries(chosen.files, poses, {settings.point_layout});
  add_poses(poses, sequence);
  add_label_files(folder / "labels", entries, sequence);
  if (settings.moving_now && sequence.labels) {
    const auto movers = folder / kMoversFile;
    sequence.input_files.push_back(movers);
    sequence.labels = moving_now_labels(sequence.labels, movers, frame_numbers(chosen, poses));
    sequence.moving_now = true;
  }
  FileScanSource::Traits traits;
  traits.point_frame = settings.points.value_or(PointFrame::kSensor);
  traits.reading.point_layout = settings.point_layout;
  const auto source =
      std::make_shared<FileScanSource>(std::move(entries), std::move(traits), settings.sensor);
  sequence.scans = source;
  sequence.records = source;
  return sequence;
}

Layout semantickitti_layout() {
  Layout layout;
  layout.name = "semantickitti";
  layout.expected = "a SemanticKITTI sequence (velodyne/*.bin, poses.txt, calib.txt)";
  layout.forms = {
      {"FOLDER", "a folder in SemanticKITTI layout (velodyne/*.bin, poses.txt, calib.txt)"}};
  layout.scan_folder = "velodyne";
  layout.calibration_file = "calib.txt";
  layout.pose_place = PosePlace::kRowOfFrameNumber;
  layout.class_names = semantickitti_class_names();
  layout.recognise = [](Layout::Path path) {
    return is_folder(path) && has_folder(std::filesystem::path(path) / "velodyne");
  };
  layout.open = [](Layout::Path path, const SequenceOptions& options, const OpenContext& context) {
    return open_semantickitti(path, options, context);
  };
  return layout;
}

}  // namespace raymoval
