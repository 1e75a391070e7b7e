// SPDX-License-Identifier: MIT
#include "datasets/layout.h"

#include "datasets/settings.h"
#include "datasets/world_axes/up_direction.h"

namespace raymoval {

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
