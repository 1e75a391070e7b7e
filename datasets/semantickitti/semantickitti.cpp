// SPDX-License-Identifier: MIT
#include "datasets/semantickitti/semantickitti.h"

#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"
#include "datasets/clouds/frames.h"
#include "datasets/clouds/poses.h"
#include "datasets/settings.h"

namespace raymoval {
namespace {

/// A surplus of rows is normal (frames absent from the disk); a lack means that file and scans do
/// not belong together, and then no row can be trusted.
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
                    ": is missing; its row 'Tr:' takes camera poses to the LiDAR (T = Tr^-1 P Tr). "
                    "Add it, or say \"poses_are_lidar\": true in sequence.json if the poses are "
                    "those of the LiDAR.");
  }
  return read_calibration(calibration, "Tr");
}

/// Seconds since frame 0, by frame number.
std::vector<double> frame_times(const std::filesystem::path& folder, double period,
                                const std::vector<NumberedFile>& files) {
  const auto path = folder / "times.txt";
  std::vector<double> times;
  if (has_file(path)) {
    times = read_number_column(path);
    check_row_count(times.size(), "times", path, files);
    const double start = times.front();
    for (double& time : times) time -= start;
    return times;
  }
  for (const NumberedFile& file : files) {
    times.resize(static_cast<std::size_t>(file.number) + 1);
    times.back() = static_cast<double>(file.number) * period;
  }
  return times;
}

std::vector<FrameEntry> frame_entries(const std::vector<NumberedFile>& chosen,
                                      const PoseFile& poses, const Pose& Tr,
                                      const std::vector<double>& times,
                                      const RecordReading& reading) {
  const Pose Tr_inverse = Tr.inverse();
  std::vector<FrameEntry> frames;
  for (const NumberedFile& file : chosen) {
    check_bin_size(file.path, plain_file_size(file.path), reading);
    const auto number = static_cast<std::size_t>(file.number);
    frames.push_back({file.path, "", file.path.stem().string(), times[number],
                      Tr_inverse * rigid_pose(poses, number) * Tr});
  }
  return frames;
}

/// "0:3:2" of the frames there are; empty if no range has just them.
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

/// What to say of data that lacks frames of a segment.
std::string lacks_frames_text(const std::filesystem::path& folder, const std::string& segment,
                              const FrameRange& frames, const std::vector<NumberedFile>& files) {
  const std::string part = whole_range_text(files);
  return folder.string() + ": segment " + segment + " is frames " + frame_range_text(frames) +
         ", but the data has " + frame_extent_text(files) +
         ". Copy the missing ones, or name your own part: --sequence " +
         folder.parent_path().parent_path().string() + ":" + folder.filename().string() +
         (part.empty() ? "" : " --frames " + part) + ".";
}

/// @param segment whose frames these are if the user named none; empty: of the user
ChosenFrames chosen_frames(const std::vector<NumberedFile>& files, const FrameRange& frames,
                           const std::filesystem::path& folder, const std::string& segment) {
  try {
    return choose_frames(files, frames, folder.string());
  } catch (const DataError&) {
    if (segment.empty()) throw;
    throw DataError(lacks_frames_text(folder, segment, frames, files));
  }
}

}  // namespace

Sequence open_semantickitti(const std::filesystem::path& folder, const SequenceOptions& options,
                            const std::string& name, const FrameRange& frames) {
  SequenceSettings defaults;
  defaults.name = name;
  defaults.frames = frames;
  defaults.scan_period_s = kUsualScanPeriod;  // KITTI's HDL-64E turns at 10 Hz.
  const SequenceSettings settings = read_settings(folder, options, defaults);

  const auto files = list_numbered_files(folder / "velodyne", ".bin");
  const ChosenFrames chosen =
      chosen_frames(files, settings.frames, folder, options.frames ? "" : name);
  const auto pose_path = find_pose_file(folder, settings.poses.value_or("poses.txt"));
  const PoseFile poses = read_pose_file(pose_path);
  check_row_count(poses.rows.size(), "poses", pose_path, files);
  const auto Tr = camera_calibration(folder, settings);
  auto entries =
      frame_entries(chosen.files, poses, Tr.value_or(Pose::Identity()),
                    frame_times(folder, *settings.scan_period_s, files), {settings.point_layout});

  Sequence sequence = make_sequence(settings, semantickitti_layout(), chosen.range);
  if (find_label_files(folder / "labels", entries)) {
    sequence.labels = std::make_shared<LabelFileSource>(entries);
  }
  FileScanSource::Traits traits;
  traits.reading.point_layout = settings.point_layout;
  const auto source =
      std::make_shared<FileScanSource>(std::move(entries), std::move(traits), settings.sensor);
  sequence.scans = source;
  sequence.records = source;
  sequence.T_camera_lidar = Tr;
  sequence.poses_file = pose_path.filename().string();
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
  layout.open = [](Layout::Path path, const SequenceOptions& options, const OpenContext&) {
    return open_semantickitti(path, options);
  };
  return layout;
}

}  // namespace raymoval
