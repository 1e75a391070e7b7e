// SPDX-License-Identifier: MIT
#include "datasets/layout.h"

#include <algorithm>

#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/returns.h"
#include "datasets/settings.h"
#include "datasets/world_axes/up_direction.h"

namespace raymoval {

void add_poses(const ScanPoses& poses, Sequence& sequence) {
  for (std::size_t i = 0; i < poses.poses.size(); ++i) {
    if (poses.poses[i]) sequence.stamps.push_back(poses.stamps[i]);
  }
  sequence.motion = poses.motion;
  sequence.pose_gap = poses.gap;
  sequence.notes.insert(sequence.notes.end(), poses.notes.begin(), poses.notes.end());
  sequence.losses.insert(sequence.losses.end(), poses.losses.begin(), poses.losses.end());
}

void drop_bad_files(const std::vector<NumberedFile>& files, const RecordReading& reading,
                    const OpenContext& context, std::vector<std::optional<Pose>>& poses,
                    std::vector<std::string>& losses) {
  const auto name = [&](std::size_t i) { return files[i].path.filename().string(); };
  const auto read = [&](std::size_t i) {
    const std::filesystem::path& path = files[i].path;
    Scan scan;
    (void)read_returns(
        scan, PointFrame::kSensor, path.string(),
        [&](const Eigen::Vector3d& origin) { return read_cloud(path, origin, reading); });
  };
  drop_bad_scans(poses, name, read, context.cancel, losses);
}

void add_label_files(const std::filesystem::path& folder, std::vector<FrameEntry>& frames,
                     Sequence& sequence) {
  if (!has_folder(folder)) return;
  std::size_t labelled = 0;
  for (FrameEntry& frame : frames) {
    const std::filesystem::path file = folder / (frame.name + ".label");
    if (!has_file(file) || plain_file_size(file) == 0) continue;
    frame.label_path = file;
    ++labelled;
  }
  if (labelled == frames.size()) {
    sequence.labels = std::make_shared<LabelFileSource>(frames);
    return;
  }
  const std::string share = grouped_text(labelled) + " of " + counted_text(frames.size(), "scan") +
                            " have labels in " + folder.filename().string() + "/";
  if (labelled == 0) {
    sequence.notes.push_back(share + ", so there are no labels.");
    return;
  }
  sequence.losses.push_back(share + "; only these are scored.");
  sequence.labels = std::make_shared<LabelFileSource>(frames);
  std::vector<std::uint16_t>& ignored = sequence.label_rule.ignored;
  if (std::find(ignored.begin(), ignored.end(), kNoLabelFile) == ignored.end()) {
    ignored.push_back(kNoLabelFile);
  }
}

Sequence make_sequence(const SequenceSettings& settings, const Layout& layout,
                       const FrameRange& range) {
  Sequence sequence;
  sequence.name = settings.name;
  sequence.layout = layout.name;
  sequence.label_rule = settings.label_rule;
  sequence.label_rule.class_names = layout.class_names;
  sequence.range_m = settings.range_m;
  sequence.drop_ego = settings.drop_ego;
  sequence.frames = frame_range_text(range);
  sequence.source = settings.source;
  sequence.scan_period_s = settings.scan_period_s;
  sequence.deskew = settings.deskew;
  sequence.point_time_unit = settings.point_time_unit;
  sequence.T_sensor = settings.T_sensor;
  sequence.sensor_origin = settings.sensor_origin;
  sequence.time_offset_s = settings.time_offset_s;
  sequence.input_files = settings.input_files;
  sequence.up_choice = std::make_shared<UpChoice>(settings.up);
  return sequence;
}

}  // namespace raymoval
