// SPDX-License-Identifier: MIT
#include "benchmark/cli/commands.h"
#include "benchmark/suite/amounts.h"

namespace raymoval {
namespace {

EgoRegion parse_drop_ego(const std::string& text) {
  try {
    return parse_ego_region(text);
  } catch (const UsageError& error) {
    throw UsageError("--drop-ego " + std::string(error.what()));
  }
}

}  // namespace

void SequenceFlags::add_place_to(CommandOptions& options, std::string& place) {
  options.add("path,--sequence", "PATH", place, "Sequence folder, ROOT:05, `street`, or a scene");
}

void SequenceFlags::add_to(CommandOptions& options) {
  options.add("--frames", "FIRST:LAST:STRIDE", frames, "Frames, ends included; parts may be empty");
  options.add("--poses", "FILE", poses, "Pose file: a name in the sequence folder, or a path");
  options.add("--label-rule", "FILE", label_rule, "JSON file that says which labels move");
  options.add("--range", "MIN:MAX", range,
              "Metres; points beyond are not evaluated, but methods see them (see --drop-ego)");
  options.add("--sensor", "NAME", sensor,
              "A known sensor (see `raymoval list sensors`), or estimated");
  options.add("--up", "AXIS", up,
              "Up in the world of the poses: z, -y, or x,y,z (default: estimated)");
  options.add("--drop-ego", "WHERE", drop_ego,
              "Leave out points of the own vehicle, so that no method sees them: auto "
              "(estimated), a radius (2.4), or a box XMIN:XMAX,YMIN:YMAX,ZMIN:ZMAX of the "
              "sensor frame");
  options.add("--name", "NAME", name, "Name of the sequence in results");
}

std::string SequenceFlags::first_given() const {
  const std::pair<const char*, const std::string*> all[] = {
      {"--frames", &frames},     {"--poses", &poses},   {"--label-rule", &label_rule},
      {"--range", &range},       {"--sensor", &sensor}, {"--up", &up},
      {"--drop-ego", &drop_ego}, {"--name", &name}};
  for (const auto& [option, text] : all) {
    if (!text->empty()) return option;
  }
  return "";
}

SequenceOptions SequenceFlags::options() const {
  SequenceOptions options;
  if (!frames.empty()) options.frames = parse_frame_range(frames);
  if (!poses.empty()) options.poses = poses;
  if (!label_rule.empty()) options.label_rule = label_rule;
  if (!sensor.empty()) options.sensor = sensor;
  if (!up.empty()) options.up = up;
  if (!drop_ego.empty()) options.drop_ego = parse_drop_ego(drop_ego);
  if (!name.empty()) options.name = name;
  if (range.empty()) return options;
  options.range_m = parse_range("--range", range);
  return options;
}

}  // namespace raymoval
