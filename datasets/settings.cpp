// SPDX-License-Identifier: MIT
#include "datasets/settings.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/fields.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/name.h"
#include "core/scan/sensor_model.h"
#include "core/text.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/deskew/deskew.h"
#include "datasets/ego/sensor_places.h"
#include "datasets/trajectories/body_sensor.h"

namespace raymoval {
namespace {

using nlohmann::json;

/// "-y", or a list of three numbers.
Eigen::Vector3d up_value(const json& value, const std::string& where) {
  std::string text = value.is_string() ? value.get<std::string>() : "";
  if (value.is_array() && value.size() == 3) {
    text = value[0].dump() + "," + value[1].dump() + "," + value[2].dump();
  }
  const auto up = parse_up(text);
  if (!up) {
    throw ConfigurationError(where + ": " + value.dump() + " is not a direction; " + kUpForm + ".");
  }
  return *up;
}

RangeLimits range_value(const Fields& file) {
  const Fields f(file.member("range_m"), file.place("range_m"), "min max");
  RangeLimits range;
  range.min = f.number("min", range.min, 0.0);
  range.max = f.number("max", range.max, 0.0);
  return range;
}

/// A name of a sensor; no value for an empty name.
std::optional<std::string> sensor_value(const std::string& name) {
  if (name.empty()) return std::nullopt;
  return name;
}

std::optional<std::string> text_value(const Fields& file, const std::string& key) {
  return file.has(key) ? std::optional(file.text(key)) : std::nullopt;
}

/// Calls `read` and reports its errors as errors of a file. @param where begins them
template <class Read>
auto read_in_file(const std::string& where, Read&& read) {
  try {
    return read();
  } catch (const UsageError& error) {
    throw ConfigurationError(where + ": " + error.what());
  }
}

/// Applies the keys of a file on poses and on motion within scans.
void apply_pose_keys(const Fields& file, SequenceSettings& settings) {
  settings.poses_are_lidar = file.flag("poses_are_lidar", settings.poses_are_lidar);
  if (file.has("poses")) settings.poses = file.text("poses", "");
  settings.pose_format = text_value(file, "pose_format");
  settings.T_sensor = text_value(file, "T_sensor");
  settings.point_time_unit = text_value(file, "point_time_unit");
  if (settings.point_time_unit) {
    read_in_file(file.place("point_time_unit"),
                 [&] { return seconds_of_unit(*settings.point_time_unit); });
  }
  settings.deskew = file.flag("deskew", settings.deskew);
  if (file.has("sensor_origin")) {
    settings.sensor_origin = read_in_file(file.place("sensor_origin"), [&] {
      return parse_sensor_places(file.text("sensor_origin"));
    });
  }
  settings.skip_bad_scans = file.flag("skip_bad_scans", settings.skip_bad_scans);
  if (file.has("time_offset_s")) settings.time_offset_s = file.number("time_offset_s", 0.0);
  if (file.has("max_gap_s")) settings.max_gap_s = file.positive("max_gap_s", 1.0);
  if (file.has("points")) {
    const std::string points = file.choice("points", "sensor", {"sensor", "world"});
    settings.points = parse_point_frame(file.place("points"), points);
  }
}

void apply_file(const std::filesystem::path& path, SequenceSettings& settings) {
  const json content = read_json(path);
  const Fields file(
      content, path.string(),
      "name source sensor up scan_period_s poses poses_are_lidar range_m labels "
      "drop_ego point_layout pose_format T_sensor sensor_origin time_offset_s max_gap_s points "
      "deskew point_time_unit skip_bad_scans");
  settings.name = file.text("name", settings.name);
  settings.source = file.text("source", settings.source);
  if (file.has("sensor")) settings.sensor = sensor_value(file.text("sensor", ""));
  if (file.has("up")) settings.up = up_value(file.member("up"), file.place("up"));
  if (file.has("drop_ego")) {
    settings.drop_ego = ego_region_value(file.member("drop_ego"), file.place("drop_ego"));
  }
  apply_pose_keys(file, settings);
  settings.point_layout = text_value(file, "point_layout");
  if (settings.point_layout) {
    read_in_file(file.place("point_layout"),
                 [&] { return parse_point_layout(*settings.point_layout); });
  }
  if (file.has("scan_period_s")) {
    settings.scan_period_s = file.number("scan_period_s", 0.0);
    if (!(*settings.scan_period_s > 0.0)) file.fail("scan_period_s", "a number above 0");
  }
  if (file.has("range_m")) settings.range_m = range_value(file);
  if (file.has("labels")) {
    LabelRule base = settings.label_rule;
    if (!settings.name.empty()) base.name = settings.name;
    settings.label_rule = label_rule_from_json(file.member("labels"), base, file.place("labels"));
    settings.label_rule_given = true;
  }
}

/// The name becomes part of file names and table rows.
void check_name(const std::string& name) {
  const std::string problem = name_problem(name);
  if (problem.empty()) return;
  throw ConfigurationError("sequence name '" + name + "': " + problem + "; expected " + kNameForm +
                           ". Give one with --name or \"name\" in sequence.json.");
}

void check_pose_settings(const SequenceSettings& settings) {
  const double most = to_seconds(kMostOffset);
  if (settings.time_offset_s && !(std::abs(*settings.time_offset_s) <= most)) {
    throw ConfigurationError("time offset " + number_text(*settings.time_offset_s) +
                             " s of sequence " + settings.name + ": expected at most " +
                             number_text(most) + " s either way.");
  }
  if (settings.max_gap_s && !(*settings.max_gap_s > 0.0 && *settings.max_gap_s <= 1e6)) {
    throw ConfigurationError("largest gap " + number_text(*settings.max_gap_s) + " s of sequence " +
                             settings.name + ": expected more than 0 and at most 1,000,000 s.");
  }
}

void check_settings(const SequenceSettings& settings) {
  check_name(settings.name);
  check_pose_settings(settings);
  const RangeLimits& range = settings.range_m;
  if (!(range.min >= 0.0 && range.min < range.max)) {
    throw ConfigurationError("range_m of sequence " + settings.name + ": min " +
                             number_text(range.min) + " and max " + number_text(range.max) +
                             "; expected 0 <= min < max in metres.");
  }
  if (settings.sensor && *settings.sensor != "estimated") {
    const auto known = sensor_model_names();
    if (std::find(known.begin(), known.end(), *settings.sensor) == known.end()) {
      auto choices = known;
      choices.emplace_back("estimated");
      throw ConfigurationError("sensor '" + *settings.sensor + "' of sequence " + settings.name +
                               " is unknown." + suggestion(*settings.sensor, choices) +
                               " 'estimated' takes the field of view from the scans.");
    }
  }
}

std::string folder_name(const std::filesystem::path& folder) {
  std::error_code error;
  const auto whole = std::filesystem::weakly_canonical(folder, error);
  if (error) {
    throw UnreadableError(folder.string() + ": cannot be accessed (" + error.message() + ").");
  }
  const auto name = whole.filename();
  return name.empty() ? "sequence" : name.string();
}

/// Applies the user's options on poses.
void apply_pose_options(const SequenceOptions& options, SequenceSettings& settings) {
  if (options.poses) settings.poses = options.poses;
  if (options.pose_format) settings.pose_format = options.pose_format;
  if (options.T_sensor) settings.T_sensor = options.T_sensor;
  if (options.sensor_origin) settings.sensor_origin = options.sensor_origin;
  if (options.time_offset_s) settings.time_offset_s = options.time_offset_s;
  if (options.max_gap_s) settings.max_gap_s = options.max_gap_s;
  if (options.points) settings.points = options.points;
  if (options.deskew) settings.deskew = *options.deskew;
  if (!options.point_time_unit) return;
  (void)seconds_of_unit(*options.point_time_unit);  // Throws for a bad unit, even if not needed.
  settings.point_time_unit = options.point_time_unit;
}

}  // namespace

EgoRegion ego_region_value(const json& value, const std::string& where) {
  return read_in_file(where, [&] {
    if (value.is_number()) return parse_ego_region(number_text(value.get<double>()));
    if (!value.is_string()) throw UsageError("expected a text in quotes.");
    return parse_ego_region(value.get<std::string>());
  });
}

std::string first_pose_setting(const SequenceSettings& settings) {
  if (settings.poses) return "--poses";
  if (settings.pose_format) return "--pose-format";
  if (settings.T_sensor) return "--T-sensor";
  if (settings.time_offset_s) return "--time-offset";
  return settings.max_gap_s ? "--max-gap" : "";
}

PointFrame parse_point_frame(const std::string& option, const std::string& text) {
  if (text == "sensor") return PointFrame::kSensor;
  if (text == "world") return PointFrame::kWorld;
  throw UsageError(option + " " + text +
                   ": expected sensor or world, the frame that the points are stored in.");
}

PoseSettings pose_settings(const SequenceSettings& settings, const std::filesystem::path& folder,
                           std::vector<std::filesystem::path>& input_files) {
  PoseSettings result;
  if (settings.time_offset_s) result.time_offset = from_seconds(*settings.time_offset_s);
  if (settings.max_gap_s) result.max_gap = from_seconds(*settings.max_gap_s);
  if (!settings.T_sensor) return result;
  const BodySensor sensor = read_body_sensor(*settings.T_sensor, folder);
  result.T_body_sensor = sensor.T_body_sensor;
  if (sensor.file) input_files.push_back(*sensor.file);
  return result;
}

SequenceSettings apply_options(const SequenceOptions& options, SequenceSettings settings) {
  if (options.frames) settings.frames = *options.frames;
  settings.skip_bad_scans = settings.skip_bad_scans || options.skip_bad_scans;
  apply_pose_options(options, settings);
  if (options.range_m) settings.range_m = *options.range_m;
  if (options.sensor) settings.sensor = sensor_value(*options.sensor);
  if (options.point_layout) {
    (void)parse_point_layout(*options.point_layout);
    settings.point_layout = options.point_layout;
  }
  if (options.drop_ego) settings.drop_ego = *options.drop_ego;
  if (options.name) settings.name = *options.name;
  if (options.up) {
    settings.up = parse_up(*options.up);
    if (!settings.up) throw UsageError("--up " + *options.up + ": " + kUpForm + ".");
  }
  if (options.label_rule && !is_rule_file(*options.label_rule)) {
    settings.moving_now = true;
    settings.label_rule.name = kMovingNow;
  } else if (options.label_rule) {
    settings.input_files.push_back(*options.label_rule);
    LabelRule base;
    base.name = options.label_rule->stem().string();
    settings.label_rule =
        label_rule_from_json(read_json(*options.label_rule), base, options.label_rule->string());
    settings.label_rule_given = true;
  }
  check_settings(settings);
  return settings;
}

SequenceSettings read_settings(const std::filesystem::path& folder, const SequenceOptions& options,
                               const SequenceSettings& defaults) {
  SequenceSettings settings = defaults;
  const auto file = folder / "sequence.json";
  if (has_file(file)) {
    apply_file(file, settings);
    settings.input_files.push_back(file);
  }
  if (!defaults.name.empty()) settings.name = defaults.name;
  if (settings.name.empty()) settings.name = folder_name(folder);
  return apply_options(options, settings);
}

std::filesystem::path find_pose_file(const std::filesystem::path& folder,
                                     const std::optional<std::string>& name) {
  const std::string wanted = name.value_or("poses.txt");
  if (has_file(folder / wanted)) return folder / wanted;
  if (name && has_file(wanted)) return wanted;
  std::vector<std::string> there;
  for (const auto& path : list_files(folder, {".txt", ".csv", ".tum", ".npy", ".g2o", ".json"})) {
    if (path.filename() == "sequence.json") continue;
    if (there.size() < 8) there.push_back(path.filename().string());
  }
  throw DataError(folder.string() + ": there is no pose file '" + wanted + "'; found " +
                  (there.empty() ? "no .txt, .csv, .tum, .npy, .g2o or .json file" : join(there)) +
                  ". Name one with --poses or \"poses\" in sequence.json." +
                  (name ? "" : " " + ways_to_poses()));
}

}  // namespace raymoval
