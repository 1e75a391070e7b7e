// SPDX-License-Identifier: MIT
#include "datasets/dynamicmap/dynamicmap.h"

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"
#include "datasets/clouds/frames.h"
#include "datasets/settings.h"

namespace raymoval {

Sequence open_dynamicmap(const std::filesystem::path& folder, const SequenceOptions& options) {
  SequenceSettings defaults;
  defaults.label_rule = {"dynamicmap", {1}, {}};
  const SequenceSettings settings = read_settings(folder, options, defaults);
  if (settings.poses) {
    throw UsageError(folder.string() + ": a pose file ('" + *settings.poses +
                     "') cannot be used: the points of this layout stand in the world frame of the "
                     "poses in the VIEWPOINT of each .pcd file. Leave --poses out.");
  }
  const auto files = list_numbered_files(folder / "pcd", ".pcd");
  const ChosenFrames chosen = choose_frames(files, settings.frames, folder.string());
  std::vector<FrameEntry> entries;
  for (const NumberedFile& file : chosen.files) {
    FrameEntry frame;
    frame.path = file.path;
    frame.name = file.path.stem().string();
    frame.time_s = static_cast<double>(file.number - files.front().number) *
                   settings.scan_period_s.value_or(kUsualScanPeriod);
    frame.T_world_sensor = read_viewpoint(file.path);
    entries.push_back(std::move(frame));
  }

  Sequence sequence = make_sequence(settings, "dynamicmap", chosen.range);
  sequence.poses_file = "VIEWPOINT";
  if (settings.label_rule_given) sequence.labels = std::make_shared<IntensityLabelSource>(entries);
  const FileScanSource::Traits traits{FileScanSource::PointFrame::kWorld, false};
  sequence.scans = std::make_shared<FileScanSource>(std::move(entries), traits, settings.sensor);
  return sequence;
}

}  // namespace raymoval
