// SPDX-License-Identifier: MIT
#include "datasets/layout.h"

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"
#include "datasets/clouds/frames.h"
#include "datasets/settings.h"

namespace raymoval {
namespace {

/// The classes of SemanticKITTI. With labels 0 and 1, only 1 moves.
ClassNames class_names() {
  ClassNames names = semantickitti_class_names();
  names.erase(0);
  names.erase(1);
  return names;
}

/// Refuses options on poses and frame, which the files define.
void check_no_pose_settings(const SequenceSettings& settings, const std::filesystem::path& folder) {
  const std::string why =
      " cannot be used: the poses of this layout are in the VIEWPOINT of each .pcd file. ";
  if (settings.poses) {
    throw UsageError(folder.string() + ": a pose file ('" + *settings.poses + "')" + why +
                     "Leave --poses out.");
  }
  const std::string given = first_pose_setting(settings);
  if (given.empty()) return;
  throw UsageError(folder.string() + ": " + given + why + "Leave it out.");
}

Sequence open_dynamicmap(Layout::Path path, const SequenceOptions& options,
                         const OpenContext& context) {
  const std::filesystem::path folder = path;
  SequenceSettings defaults;
  defaults.label_rule = {"dynamicmap", {1}, {}};
  const SequenceSettings settings = read_settings(folder, options, defaults);
  check_no_pose_settings(settings, folder);
  const auto files = list_numbered_files(folder / "pcd", ".pcd");
  const ChosenFrames chosen = choose_frames(files, settings.frames, folder.string());
  Sequence sequence = make_sequence(settings, dynamicmap_layout(), chosen.range);
  std::vector<FrameEntry> entries;
  std::vector<std::optional<Pose>> poses(chosen.files.size(), Pose::Identity());
  if (settings.skip_bad_scans) {
    drop_bad_files(chosen.files, {}, context, poses, sequence.losses);
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i]) continue;
    const NumberedFile& file = chosen.files[i];
    const double time = static_cast<double>(file.number - files.front().number) *
                        settings.scan_period_s.value_or(kUsualScanPeriod);
    entries.push_back({file.path, "", file.path.stem().string(), time, read_viewpoint(file.path)});
    poses[i] = entries.back().T_world_sensor;
    sequence.stamps.push_back(from_seconds(time));
  }

  sequence.poses_file = "VIEWPOINT";
  if (settings.label_rule_given) sequence.labels = std::make_shared<IntensityLabelSource>(entries);
  FileScanSource::Traits traits;
  traits.point_frame = settings.points.value_or(PointFrame::kWorld);
  traits.has_reflectance = false;
  const auto source =
      std::make_shared<FileScanSource>(std::move(entries), std::move(traits), settings.sensor);
  sequence.scans = source;
  sequence.records = source;
  std::erase(poses, std::nullopt);
  sequence.motion = motion_along(sequence.stamps, poses);
  return sequence;
}

}  // namespace

Layout dynamicmap_layout() {
  Layout layout;
  layout.name = "dynamicmap";
  layout.expected = "a DynamicMap sequence (pcd/*.pcd)";
  layout.forms = {{"FOLDER", "a folder in DynamicMap layout (pcd/*.pcd)"}};
  layout.scan_folder = "pcd";
  layout.pose_place = PosePlace::kScanFile;
  layout.labels_in_intensity = true;
  layout.class_names = class_names();
  layout.expected_labels =
      "--label-rule FILE, because labels are the intensity of the points in this layout: a JSON "
      "file with those that move, such as {\"moving\": [1]}";
  layout.recognise = [](Layout::Path path) {
    return is_folder(path) && has_folder(std::filesystem::path(path) / "pcd");
  };
  layout.open = open_dynamicmap;
  return layout;
}

}  // namespace raymoval
