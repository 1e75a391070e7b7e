// SPDX-License-Identifier: MIT
#include "datasets/layout.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/files/same_file.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"
#include "datasets/clouds/frames.h"
#include "datasets/settings.h"
#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/stamps.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// @param others files in any folder that are no scans: poses, T_sensor
std::vector<NumberedFile> scan_files(const fs::path& folder, const std::vector<fs::path>& others) {
  std::vector<NumberedFile> files;
  std::map<std::string, std::string> names;
  for (const auto& path : list_files(folder, cloud_extensions())) {
    const bool is_other = std::any_of(others.begin(), others.end(), [&](const fs::path& other) {
      return is_same_file(path, other);
    });
    if (is_other) continue;
    // a.pcd and a.ply would share a label file and are most likely one scan twice.
    const auto [other, is_new] = names.emplace(cloud_stem(path), path.filename().string());
    if (!is_new) {
      throw DataError(path.string() + ": there is also " + other->second +
                      "; keep one file a scan.");
    }
    files.push_back({static_cast<long>(files.size()), path});
  }
  if (files.empty()) {
    throw DataError(folder.string() +
                    ": holds no scan besides the files that were named for "
                    "poses; expected one scan a file.");
  }
  return files;
}

/// The time of each scan: a line of times.txt or timestamps.txt for each. KITTI's raw data have
/// timestamps.txt beside their folder `data`. @return empty if there is no such file
StampColumn listed_stamps(const fs::path& folder, const std::vector<NumberedFile>& files,
                          std::vector<fs::path>& input_files) {
  for (const fs::path& path :
       {folder / "times.txt", folder / "timestamps.txt",
        folder.filename() == "data" ? folder.parent_path() / "timestamps.txt" : folder / "."}) {
    if (path.filename() == "." || !has_file(path)) continue;
    input_files.push_back(path);
    StampColumn column = read_stamp_file(path);
    if (column.stamps.size() == files.size()) return column;
    throw DataError(path.string() + ": holds " + counted_text(column.stamps.size(), "time") +
                    ", but " + folder.string() + " holds " + counted_text(files.size(), "scan") +
                    "; expected a time for each scan in the order of the names.");
  }
  return {};
}

/// Sorts scans whose names are times by time.
/// @param poses null for a stationary sensor
/// @return the times; empty if names are no times
StampColumn order_by_names(std::vector<NumberedFile>& files, const PoseFile* poses,
                           Nanoseconds time_offset, std::vector<std::string>& notes) {
  std::vector<std::string> stems;
  for (const NumberedFile& file : files) stems.push_back(cloud_stem(file.path));
  std::optional<std::pair<Nanoseconds, Nanoseconds>> span;
  if (poses != nullptr && poses->stamped()) {
    span.emplace(*poses->rows.front().stamp - time_offset, *poses->rows.back().stamp - time_offset);
  }
  const auto named = stamps_in_names(stems, span);
  if (!named) return {};
  if (!named->note.empty()) notes.push_back(named->note);
  std::vector<std::pair<Nanoseconds, fs::path>> order;
  for (std::size_t i = 0; i < files.size(); ++i) {
    order.emplace_back(named->stamps[i], std::move(files[i].path));
  }
  std::sort(order.begin(), order.end());
  StampColumn column;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const Nanoseconds stamp = order[i].first;
    files[i].path = std::move(order[i].second);
    column.stamps.push_back(stamp);
    column.since_first.push_back(to_seconds(stamp - column.stamps.front()));
    inside += !span || (stamp >= span->first && stamp <= span->second) ? 1 : 0;
  }
  // Times with an unknown zero are on another clock if fewer than half lie within the poses' times.
  const bool other_clock = !named->since_1970 && 2 * inside < files.size();
  if (other_clock && poses->rows.size() == files.size()) return {};
  return column;
}

/// Numbers, names and times of the chosen scans.
ScanKeys keys_of_files(const std::vector<NumberedFile>& chosen,
                       const std::vector<NumberedFile>& all, const StampColumn& times,
                       double period_s) {
  ScanKeys keys;
  keys.row_count = all.size();
  keys.extent = counted_text(all.size(), "scan") + ", " + all.front().path.filename().string() +
                " to " + all.back().path.filename().string();
  for (const NumberedFile& file : chosen) {
    keys.add(static_cast<std::size_t>(file.number), times, period_s);
    const auto frame = parse_number<long>(cloud_stem(file.path));
    if (frame) keys.frames.push_back(*frame);
  }
  if (keys.frames.size() != chosen.size()) keys.frames.clear();
  return keys;
}

/// The source of the poses.
struct PosePlaceFound {
  std::optional<fs::path> file;  ///< Empty for a stationary sensor.
  PoseSettings settings;
};

PosePlaceFound find_poses(const fs::path& folder, const SequenceSettings& settings,
                          std::vector<fs::path>& input_files) {
  PosePlaceFound found;
  found.settings = pose_settings(settings, folder, input_files);
  if (settings.poses == kStationarySensor) return found;
  found.file = find_pose_file(folder, settings.poses);
  input_files.push_back(*found.file);
  return found;
}

Sequence open_files(Layout::Path path, const SequenceOptions& options, const OpenContext& context) {
  const fs::path folder = path;
  const SequenceSettings settings = read_settings(folder, options, {});
  std::vector<fs::path> input_files;
  const PosePlaceFound place = find_poses(folder, settings, input_files);
  auto files = scan_files(folder, input_files);
  std::optional<PoseFile> file;
  if (place.file) file = read_pose_file(*place.file, {settings.pose_format});
  std::vector<std::string> notes;
  StampColumn times =
      order_by_names(files, file ? &*file : nullptr, place.settings.time_offset, notes);
  StampColumn listed = listed_stamps(folder, files, input_files);
  if (!listed.stamps.empty()) times = std::move(listed);
  const ChosenFrames chosen = choose_frames(files, settings.frames, folder.string());
  const ScanKeys keys =
      keys_of_files(chosen.files, files, times, settings.scan_period_s.value_or(kUsualScanPeriod));
  ScanPoses poses =
      file ? scan_poses(*file, keys, place.settings) : stationary_poses(keys, place.settings);
  if (settings.skip_bad_scans) {
    drop_bad_files(chosen.files, {settings.point_layout}, context, poses.poses, poses.losses);
  }

  Sequence sequence = make_sequence(settings, files_layout(), chosen.range);
  std::vector<FrameEntry> entries;
  std::vector<fs::path> scans;
  for (std::size_t i = 0; i < chosen.files.size(); ++i) {
    if (!poses.poses[i]) continue;
    const fs::path& scan = chosen.files[i].path;
    scans.push_back(scan);
    entries.push_back({scan, "", cloud_stem(scan), poses.times_s[i], *poses.poses[i]});
  }
  sequence.T_body_sensor = place.settings.T_body_sensor;
  sequence.notes = std::move(notes);
  add_poses(poses, sequence);
  sequence.input_files.insert(sequence.input_files.end(), input_files.begin(), input_files.end());
  sequence.poses_file = file ? file->path.filename().string() : kStationarySensor;
  add_label_files(folder / "labels", entries, sequence);
  FileScanSource::Traits traits;
  traits.point_frame = settings.points.value_or(PointFrame::kSensor);
  traits.reading.point_layout = settings.point_layout;
  check_bin_width(scans, traits.reading);
  const auto source =
      std::make_shared<FileScanSource>(std::move(entries), std::move(traits), settings.sensor);
  sequence.scans = source;
  sequence.records = source;
  return sequence;
}

}  // namespace

Layout files_layout() {
  Layout layout;
  layout.name = "files";
  layout.expected = "a folder of .pcd, .ply, .bin, .las, .npy or .npz scans with poses.txt";
  layout.forms = {{"FOLDER", layout.expected}};
  layout.pose_place = PosePlace::kRowOfScan;
  layout.class_names = semantickitti_class_names();
  layout.recognise = [](Layout::Path path) {
    return is_folder(path) && !list_files(path, cloud_extensions()).empty();
  };
  layout.open = open_files;
  return layout;
}

}  // namespace raymoval
