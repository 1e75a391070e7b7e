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
       "Pose file: a name in the sequence folder, or a path; the word identity for a sensor that "
       "stands",
       set_text<&Options::poses>},
      {"pose-format", "NAME",
       "Form of the pose file (see `raymoval list pose-formats`; default: told by its content); "
       "inverse, or NAME:inverse, if its poses take the world to the sensor",
       set_text<&Options::pose_format>},
      {"T-sensor", "POSE",
       "Pose of the sensor in the frame of the body that the poses are about: "
       "x,y,z,qx,qy,qz,qw in metres, or a file with these or a 4 x 4 matrix",
       set_text<&Options::T_sensor>},
      {"sensor-origin", "X,Y,Z",
       "Position of the sensor in the frame of the points, metres, where that is not the sensor's "
       "own: points in the frame of a vehicle. Merged clouds of several sensors: "
       "FIELD:NUMBER=X,Y,Z/NUMBER=X,Y,Z, where FIELD names the sensor of a point",
       [](Options& o, Text option, Text text) {
         o.sensor_origin = in_option(option, [&] { return parse_sensor_places(text); });
       }},
      {"time-offset", "SECONDS", "Added to the times of the scans before poses are looked up",
       set_time_offset},
      {"max-gap", "SECONDS",
       "Poses that are further apart in time are not interpolated (default: 1)",
       [](Options& o, Text option, Text text) { o.max_gap_s = parse_positive(option, text); }},
      {"points", "FRAME",
       "The frame that points are stored in: sensor, or world if the poses are applied to them "
       "already",
       [](Options& o, Text option, Text text) { o.points = parse_point_frame(option, text); }},
      {"deskew", "",
       "Take the motion of the sensor during a scan out of its points, by their times",
       [](Options& o, Text, Text) { o.deskew = true; }},
      {"point-time-unit", "UNIT",
       "What one of a point's time is: s, ms, us, ns, or a number of seconds (default: told by the "
       "times of a scan)",
       set_text<&Options::point_time_unit>},
      {"topic", "NAME", "Topic of a recording with the scans (default: the only one with clouds)",
       set_text<&Options::topic>},
      {"pose-topic", "NAME", "Topic of a recording with the poses (default: its odometry, else tf)",
       set_text<&Options::pose_topic>},
      {"label-rule", "FILE",
       "JSON file that says which labels move; or moving-now: what moves at the time of the scan, "
       "where the data says it",
       set_text<&Options::label_rule>},
      {"range", "MIN:MAX",
       "Distance from the sensor in metres. Points outside it are not evaluated, but methods see "
       "them (see --drop-ego)",
       [](Options& o, Text option, Text text) { o.range_m = parse_range(option, text); }},
      {"sensor", "NAME", "A known sensor (see `raymoval list sensors`), or the word estimated",
       set_text<&Options::sensor>},
      {"up", "AXIS",
       "The direction that is up in the world of the poses: z, -y, or a vector x,y,z (default: "
       "estimated)",
       set_text<&Options::up>},
      {"drop-ego", "WHERE",
       "Leave out the points on the vehicle that carries the sensor, so that no method sees them: "
       "auto (estimated), a radius (2.4), or a box XMIN:XMAX,YMIN:YMAX,ZMIN:ZMAX in the sensor "
       "frame",
       [](Options& o, Text option, Text text) {
         o.drop_ego = in_option(option, [&] { return parse_ego_region(text); });
       }},
      {"point-layout", "FIELDS",
       "The fields of a point in .bin and .npy scans, such as \"x y z intensity ring:u2 t:f8\" "
       "(float32 where no type is given)",
       set_text<&Options::point_layout>},
      {"skip-bad-scans", "", "Leave out scans that are truncated or cannot be read, and say which",
       [](Options& o, Text, Text) { o.skip_bad_scans = true; }},
      {"name", "NAME", "The name of the sequence in the results", set_text<&Options::name>}};
  return list;
}

}  // namespace raymoval
