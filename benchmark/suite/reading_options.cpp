// SPDX-License-Identifier: MIT
#include "benchmark/suite/reading_options.h"

#include <cmath>

#include "benchmark/suite/amounts.h"
#include "core/error.h"
#include "core/text.h"
#include "datasets/ego/sensor_places.h"
#include "datasets/reading/left_out.h"
#include "datasets/settings.h"

namespace raymoval {
namespace {

using Options = SequenceOptions;
using Text = const std::string&;

/// Stores a text option unchanged.
template <auto Member>
void set_text(Options& options, Text /*option*/, Text text) {
  options.*Member = text;
}

/// The result of `read`, whose errors get the option as prefix.
template <class Read>
auto in_option(Text option, Read&& read) {
  try {
    return read();
  } catch (const UsageError& error) {
    throw UsageError(option + " " + error.what());
  }
}

/// A number of seconds of either sign.
void set_time_offset(Options& options, Text option, Text text) {
  options.time_offset_s = parse_number<double>(text);
  if (options.time_offset_s && std::abs(*options.time_offset_s) <= to_seconds(kMostOffset)) return;
  throw UsageError(option + " " + text + ": expected a number of seconds, such as -0.05.");
}

}  // namespace

const std::vector<ReadingOption>& reading_options() {
  static const std::vector<ReadingOption> list = {
      {"frames", "FIRST:LAST:STRIDE",
       "First and last frame and the step between frames; each may be left out",
       [](Options& o, Text, Text text) { o.frames = parse_frame_range(text); }},
      {"poses", "FILE",
       "Pose file: a name in the sequence folder, or a path; the word identity for a stationary "
       "sensor, estimate to estimate the poses from the scans, or refine or refine:FILE to improve "
       "the given ones",
       set_text<&Options::poses>},
      {"pose-format", "NAME",
       "Format of the pose file (see `raymoval list pose-formats`; default: detected from its "
       "content); inverse, or NAME:inverse, if its poses transform from the world to the sensor",
       set_text<&Options::pose_format>},
      {"T-sensor", "POSE",
       "Pose of the sensor in the body frame, if the poses are those of a body: x,y,z,qx,qy,qz,qw "
       "in metres, or a file with these or a 4 x 4 matrix",
       set_text<&Options::T_sensor>},
      {"sensor-origin", "X,Y,Z",
       "Position of the sensor in the frame of the points, in metres, if points are in the frame "
       "of a vehicle. For merged clouds of several sensors: FIELD:NUMBER=X,Y,Z/NUMBER=X,Y,Z; the "
       "points have a field FIELD with the number of their sensor. For several topics whose points "
       "are in one frame: topic:0=X,Y,Z/1=X,Y,Z",
       [](Options& o, Text option, Text text) {
         o.sensor_origin = in_option(option, [&] { return parse_sensor_places(text); });
       }},
      {"time-offset", "SECONDS", "Added to the times of the scans before poses are interpolated",
       set_time_offset},
      {"max-gap", "SECONDS",
       "No pose is interpolated between two poses that are further apart in time (default: 1)",
       [](Options& o, Text option, Text text) { o.max_gap_s = parse_positive(option, text); }},
      {"points", "FRAME",
       "Frame of the stored points: sensor, or world if the poses are already applied to them",
       [](Options& o, Text option, Text text) { o.points = parse_point_frame(option, text); }},
      {"deskew", "", "Undo the motion of the sensor during each scan, by the times of its points",
       [](Options& o, Text, Text) { o.deskew = true; }},
      {"point-time-unit", "UNIT",
       "Unit of the times of points: s, ms, us, ns, or a number of seconds (default: detected from "
       "the times of a scan)",
       set_text<&Options::point_time_unit>},
      {"topic", "NAME",
       "Topic of the scans in a recording, or NAME,NAME of several sensors of one vehicle "
       "(default: "
       "the only topic with clouds)",
       set_text<&Options::topic>},
      {"pose-topic", "NAME", "Topic of the poses in a recording (default: its odometry, else tf)",
       set_text<&Options::pose_topic>},
      {"label-rule", "FILE",
       "JSON file that lists the moving labels; or moving-now: only objects that move at the time "
       "of the scan, if the data records this",
       set_text<&Options::label_rule>},
      {"range", "MIN:MAX",
       "Evaluated distance from the sensor in metres. Methods get the points outside it, too (see "
       "--drop-ego)",
       [](Options& o, Text option, Text text) { o.range_m = parse_range(option, text); }},
      {"sensor", "NAME", "A known sensor (see `raymoval list sensors`), or the word estimated",
       set_text<&Options::sensor>},
      {"up", "AXIS",
       "Up direction in the world of the poses: z, -y, or a vector x,y,z (default: estimated)",
       set_text<&Options::up>},
      {"drop-ego", "WHERE",
       "Drop the points on the ego vehicle before any method runs: auto (estimated), a radius "
       "(2.4), or a box XMIN:XMAX,YMIN:YMAX,ZMIN:ZMAX in the sensor frame",
       [](Options& o, Text option, Text text) {
         o.drop_ego = in_option(option, [&] { return parse_ego_region(text); });
       }},
      {"point-layout", "FIELDS",
       "The fields of a point in .bin and .npy scans, such as \"x y z intensity ring:u2 t:f8\" "
       "(float32 where no type is given)",
       set_text<&Options::point_layout>},
      {"skip-bad-scans", "", "Leave out, and list, scans that are truncated or cannot be read",
       [](Options& o, Text, Text) { o.skip_bad_scans = true; }},
      {"name", "NAME", "The name of the sequence in the results", set_text<&Options::name>}};
  return list;
}

}  // namespace raymoval
