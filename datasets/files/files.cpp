// SPDX-License-Identifier: MIT
#include "datasets/files/files.h"

#include <map>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"
#include "datasets/clouds/frames.h"
#include "datasets/clouds/poses.h"
#include "datasets/settings.h"

namespace raymoval {
namespace {

std::vector<NumberedFile> scan_files(const std::filesystem::path& folder) {
  std::vector<NumberedFile> files;
  std::map<std::string, std::string> names;
  for (const auto& path : list_files(folder, cloud_extensions())) {
    // a.pcd and a.ply would share a label file and are most likely one scan twice.
    const auto [other, is_new] = names.emplace(cloud_stem(path), path.filename().string());
    if (!is_new) {
      throw DataError(path.string() + ": there is also " + other->second +
                      "; keep one file a scan.");
    }
    files.push_back({static_cast<long>(files.size()), path});
  }
  return files;
}

/// A pose in this layout belongs to a scan by nothing but its position, so a count that differs
/// leaves no pair to trust.
void check_counts(const PoseFile& poses, const std::vector<NumberedFile>& files,
                  const std::filesystem::path& folder) {
  if (poses.rows.size() == files.size()) return;
  throw DataError(poses.path.string() + ": holds " + grouped_text(poses.rows.size()) +
                  " poses, but " + folder.string() + " holds " + grouped_text(files.size()) +
                  " scans (" + files.front().path.filename().string() + " to " +
                  files.back().path.filename().string() +
                  "); expected one row a scan in the order of the names.");
}

Sequence open_files(Layout::Path path, const SequenceOptions& options, const OpenContext&) {
  const std::filesystem::path folder = path;
  const SequenceSettings settings = read_settings(folder, options, {});
  const auto files = scan_files(folder);
  const PoseFile poses =
      read_pose_file(find_pose_file(folder, settings.poses.value_or("poses.txt")));
  check_counts(poses, files, folder);
  const ChosenFrames chosen = choose_frames(files, settings.frames, folder.string());
  std::vector<FrameEntry> entries;
  for (const NumberedFile& file : chosen.files) {
    const auto row = static_cast<std::size_t>(file.number);
    const auto& stamp = poses.rows[row].time_s;
    const double time = stamp ? *stamp - *poses.rows.front().time_s
                              : static_cast<double>(file.number) *
                                    settings.scan_period_s.value_or(kUsualScanPeriod);
    entries.push_back({file.path, "", cloud_stem(file.path), time, rigid_pose(poses, row)});
  }

  Sequence sequence = make_sequence(settings, files_layout(), chosen.range);
  sequence.poses_file = poses.path.filename().string();
  if (find_label_files(folder / "labels", entries)) {
    sequence.labels = std::make_shared<LabelFileSource>(entries);
  }
  FileScanSource::Traits traits;
  traits.reading.point_layout = settings.point_layout;
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
  layout.expected = "a folder of .pcd, .ply or .bin scans with poses.txt";
  layout.forms = {{"FOLDER", "a folder of .pcd, .ply or .bin scans with poses.txt"}};
  layout.pose_place = PosePlace::kRowOfScan;
  layout.class_names = semantickitti_class_names();
  layout.recognise = [](Layout::Path path) {
    return is_folder(path) && !list_files(path, cloud_extensions()).empty();
  };
  layout.open = open_files;
  return layout;
}

}  // namespace raymoval
