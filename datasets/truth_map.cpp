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

/// A sensor pose far from all points, so that no point counts as a missing return or as the ego
/// vehicle, which the protocol of ERASOR leaves out.
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

/// Whether labels are DynamicMap's 0 and 1; SemanticKITTI's have other values, too.
bool has_dynamicmap_labels(const Cloud& cloud) {
  return std::all_of(cloud.intensity.begin(), cloud.intensity.end(),
                     [](float value) { return value == 0.0F || value == 1.0F; });
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
  Layout layout;
  layout.class_names = semantickitti_class_names();
  if (has_dynamicmap_labels(cloud)) {
    layout = dynamicmap_layout();
    settings.label_rule = {"dynamicmap", {1}, {}};
  }
  layout.name = kMapLayout;
  SequenceOptions chosen;
  chosen.label_rule = options.label_rule;
  chosen.name = options.name;
  settings = apply_options(chosen, settings);
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
