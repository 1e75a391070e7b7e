// SPDX-License-Identifier: MIT
#include <cmath>

#include "benchmark/cli/command.h"
#include "benchmark/suite/amounts.h"
#include "core/parallel.h"
#include "core/terminal_colour.h"
#include "core/text.h"
#include "datasets/reading/left_out.h"
#include "datasets/settings.h"

namespace raymoval {
namespace {

EgoRegion parse_drop_ego(const std::string& text) {
  try {
    return parse_ego_region(text);
  } catch (const UsageError& error) {
    throw UsageError("--drop-ego " + std::string(error.what()));
  }
}

/// A number of seconds of either sign. @throws UsageError
double parse_time_shift(const std::string& option, const std::string& text) {
  const auto value = parse_number<double>(text);
  if (value && std::abs(*value) <= to_seconds(kMostOffset)) return *value;
  throw UsageError(option + " " + text + ": expected a number of seconds, such as -0.05.");
}

}  // namespace

int parse_threads(const std::string& text) {
  if (text.empty()) return 0;
  const auto value = parse_number<int>(text);
  if (value && *value >= 1 && *value <= 4096) return *value;
  throw UsageError("--threads " + text + ": expected a whole number from 1 to 4096.");
}

double parse_positive(const std::string& option, const std::string& text) {
  const auto value = parse_number<double>(text);
  if (value && *value > 0.0 && *value < 1e6) return *value;
  throw UsageError(option + " " + text +
                   ": expected a number greater than 0 and less than 1,000,000, without a unit.");
}

ProgressStyle progress_style(bool quiet) {
  return quiet ? ProgressStyle::kQuiet : progress_style_of_stderr();
}

void WorkFlags::add_to(CommandOptions& options) {
  options.add("--threads", "N", threads, "Use at most N threads (default: all cores)");
  options.add_flag("--quiet", quiet, "Show no progress");
}

int WorkFlags::thread_count() const {
  const int given = parse_threads(threads);
  return given > 0 ? given : hardware_threads();
}

void tell_opening(const Sequence& sequence, Progress& progress) {
  progress.end();  // The messages get lines of their own.
  for (const std::string& line : sequence.notes) progress.say(sequence.name + ": " + line);
  for (const std::string& line : lost_scan_lines(sequence)) {
    print_warning(sequence.name + ": " + line);
  }
}

void SequenceFlags::add_place_to(CommandOptions& options, std::string& place) {
  options.add("path,--sequence", "PATH", place, "Sequence folder, ROOT:05, `street`, or a scene");
}

void SequenceFlags::add_to(CommandOptions& options) {
  options.add("--frames", "FIRST:LAST:STRIDE", frames,
              "First and last frame and the step between frames; each may be left out");
  add_poses_to(options);
  options.add("--topic", "NAME", topic,
              "Topic of a recording with the scans (default: the only one with clouds)");
  options.add("--pose-topic", "NAME", pose_topic,
              "Topic of a recording with the poses (default: its odometry, else tf)");
  options.add("--label-rule", "FILE", label_rule,
              "JSON file that says which labels move; or moving-now: what moves at the time of the "
              "scan, where the data says it");
  options.add(
      "--range", "MIN:MAX", range,
      "Distance from the sensor in metres. Points outside it are not evaluated, but methods see "
      "them (see --drop-ego)");
  options.add("--sensor", "NAME", sensor,
              "A known sensor (see `raymoval list sensors`), or the word estimated");
  options.add(
      "--up", "AXIS", up,
      "The direction that is up in the world of the poses: z, -y, or a vector x,y,z (default: "
      "estimated)");
  options.add("--drop-ego", "WHERE", drop_ego,
              "Leave out the points on the vehicle that carries the sensor, so that no method sees "
              "them: auto (estimated), a radius (2.4), or a box XMIN:XMAX,YMIN:YMAX,ZMIN:ZMAX in "
              "the sensor frame");
  options.add(
      "--point-layout", "FIELDS", point_layout,
      "The fields of a point in .bin and .npy scans, such as \"x y z intensity ring:u2 t:f8\" "
      "(float32 where no type is given)");
  options.add("--name", "NAME", name, "The name of the sequence in the results");
}

void SequenceFlags::add_poses_to(CommandOptions& options) {
  options.add("--poses", "FILE", poses,
              "Pose file: a name in the sequence folder, or a path; the word identity for a sensor "
              "that stands");
  options.add("--pose-format", "NAME", pose_format,
              "Form of the pose file (see `raymoval list pose-formats`; default: told by its "
              "content); inverse, or NAME:inverse, if its poses take the world to the sensor");
  options.add("--T-sensor", "POSE", T_sensor,
              "Pose of the sensor in the frame of the body that the poses are about: "
              "x,y,z,qx,qy,qz,qw in metres, or a file with these or a 4 x 4 matrix");
  options.add("--time-offset", "SECONDS", time_offset,
              "Added to the times of the scans before poses are looked up");
  options.add("--max-gap", "SECONDS", max_gap,
              "Poses that are further apart in time are not interpolated (default: 1)");
  options.add("--points", "FRAME", points,
              "The frame that points are stored in: sensor, or world if the poses are applied to "
              "them already");
  options.add_flag("--deskew", deskew,
                   "Take the motion of the sensor during a scan out of its points, by their times");
  options.add("--point-time-unit", "UNIT", point_time_unit,
              "What one of a point's time is: s, ms, us, ns, or a number of seconds (default: told "
              "by the times of a scan)");
}

std::string SequenceFlags::first_given() const {
  const std::pair<const char*, const std::string*> all[] = {{"--frames", &frames},
                                                            {"--poses", &poses},
                                                            {"--label-rule", &label_rule},
                                                            {"--range", &range},
                                                            {"--sensor", &sensor},
                                                            {"--up", &up},
                                                            {"--drop-ego", &drop_ego},
                                                            {"--point-layout", &point_layout},
                                                            {"--name", &name},
                                                            {"--pose-format", &pose_format},
                                                            {"--T-sensor", &T_sensor},
                                                            {"--time-offset", &time_offset},
                                                            {"--max-gap", &max_gap},
                                                            {"--points", &points},
                                                            {"--point-time-unit", &point_time_unit},
                                                            {"--topic", &topic},
                                                            {"--pose-topic", &pose_topic}};
  if (deskew) return "--deskew";
  for (const auto& [option, text] : all) {
    if (!text->empty()) return option;
  }
  return "";
}

SequenceOptions SequenceFlags::options() const {
  SequenceOptions options;
  if (!frames.empty()) options.frames = parse_frame_range(frames);
  if (!poses.empty()) options.poses = poses;
  if (!topic.empty()) options.topic = topic;
  if (!pose_topic.empty()) options.pose_topic = pose_topic;
  if (!label_rule.empty()) options.label_rule = label_rule;
  if (!sensor.empty()) options.sensor = sensor;
  if (!up.empty()) options.up = up;
  if (!drop_ego.empty()) options.drop_ego = parse_drop_ego(drop_ego);
  if (!point_layout.empty()) options.point_layout = point_layout;
  if (!name.empty()) options.name = name;
  if (!pose_format.empty()) options.pose_format = pose_format;
  if (!T_sensor.empty()) options.T_sensor = T_sensor;
  if (!time_offset.empty()) options.time_offset_s = parse_time_shift("--time-offset", time_offset);
  if (!max_gap.empty()) options.max_gap_s = parse_positive("--max-gap", max_gap);
  if (!points.empty()) options.points = parse_point_frame("--points", points);
  if (deskew) options.deskew = true;
  if (!point_time_unit.empty()) options.point_time_unit = point_time_unit;
  if (range.empty()) return options;
  options.range_m = parse_range("--range", range);
  return options;
}

}  // namespace raymoval
