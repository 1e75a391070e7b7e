// SPDX-License-Identifier: MIT
#include "datasets/truth_map.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"
#include "datasets/layout.h"
#include "datasets/settings.h"

namespace raymoval {
namespace {

/// Far beside all points, so that none is taken for a missing return or for the ego vehicle, which
/// the protocol of ERASOR leaves out.
Pose viewpoint_beside(const Cloud& cloud) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& point : cloud.points) {
    if (point.allFinite()) box.extend(point);
  }
  if (box.isEmpty()) return Pose::Identity();
  Eigen::Vector3d place = box.center().cast<double>();
  place.x() = std::floor(static_cast<double>(box.min().x())) - 100.0;
  return Pose(Eigen::Translation3d(place.array().round().matrix()));
}

/// DynamicMap's labels are 0 and 1; a map with SemanticKITTI's has others, too.
LabelRule rule_of(const Cloud& cloud) {
  const bool is_binary = std::all_of(cloud.intensity.begin(), cloud.intensity.end(),
                                     [](float value) { return value == 0.0F || value == 1.0F; });
  LabelRule rule;
  if (!is_binary) return rule;
  rule.name = "dynamicmap";
  rule.moving = {1};
  rule.class_names.erase(0);
  rule.class_names.erase(1);
  return rule;
}

}  // namespace

Sequence open_truth_map(const std::filesystem::path& file, const SequenceOptions& options) {
  const Cloud cloud = read_cloud(file);
  if (cloud.intensity.empty()) {
    throw DataError(file.string() +
                    ": the points have no intensity; expected the label of each point there (0 or "
                    "1, or SemanticKITTI's). Score against the scans with --sequence.");
  }
  SequenceSettings settings;
  settings.name = file.stem().string();
  settings.label_rule = rule_of(cloud);
  SequenceOptions chosen;
  chosen.label_rule = options.label_rule;
  chosen.name = options.name;
  settings = apply_options(chosen, settings);
  Layout layout;
  layout.name = kMapLayout;
  layout.class_names = settings.label_rule.class_names;
  Sequence sequence = make_sequence(settings, layout, {});
  const std::vector<FrameEntry> entries = {{file, "", settings.name, 0.0, viewpoint_beside(cloud)}};
  sequence.labels = std::make_shared<IntensityLabelSource>(entries);
  FileScanSource::Traits traits;
  traits.point_frame = PointFrame::kWorld;
  traits.has_reflectance = false;
  const auto source = std::make_shared<FileScanSource>(entries, traits, std::nullopt);
  sequence.scans = sequence.opened = source;
  sequence.records = source;
  sequence.up_choice = std::make_shared<UpChoice>(UpDirection{});
  return sequence;
}

}  // namespace raymoval
