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
#include "datasets/clouds/format/point_layout.h"

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
    throw ConfigurationError(where + ": " + value.dump() + " is no direction; " + kUpForm + ".");
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

/// A name of a sensor; an empty one says that none is named.
std::optional<std::string> sensor_value(const std::string& name) {
  if (name.empty()) return std::nullopt;
  return name;
}

/// A text that `parse_point_layout` can read.
std::string point_layout_value(const std::string& text, const std::string& where) {
  try {
    (void)parse_point_layout(text);
  } catch (const UsageError& error) {
    throw ConfigurationError(where + ": " + error.what());
  }
  return text;
}

void apply_file(const std::filesystem::path& path, SequenceSettings& settings) {
  const json content = read_json(path);
  const Fields file(
      content, path.string(),
      "name source sensor up scan_period_s poses poses_are_lidar range_m labels drop_ego "
      "point_layout");
  settings.name = file.text("name", settings.name);
  settings.source = file.text("source", settings.source);
  if (file.has("sensor")) settings.sensor = sensor_value(file.text("sensor", ""));
  if (file.has("up")) settings.up = up_value(file.member("up"), file.place("up"));
  if (file.has("drop_ego")) {
    settings.drop_ego = ego_region_value(file.member("drop_ego"), file.place("drop_ego"));
  }
  if (file.has("point_layout")) {
    settings.point_layout =
        point_layout_value(file.text("point_layout"), file.place("point_layout"));
  }
  if (file.has("poses")) settings.poses = file.text("poses", "");
  if (file.has("scan_period_s")) {
    settings.scan_period_s = file.number("scan_period_s", 0.0);
    if (!(*settings.scan_period_s > 0.0)) file.fail("scan_period_s", "a number above 0");
  }
  settings.poses_are_lidar = file.flag("poses_are_lidar", settings.poses_are_lidar);
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

void check_settings(const SequenceSettings& settings) {
  check_name(settings.name);
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
    throw UnreadableError(folder.string() + ": cannot be looked at (" + error.message() + ").");
  }
  const auto name = whole.filename();
  return name.empty() ? "sequence" : name.string();
}

}  // namespace

EgoRegion ego_region_value(const json& value, const std::string& where) {
  try {
    if (value.is_number()) return parse_ego_region(number_text(value.get<double>()));
    if (!value.is_string()) throw UsageError("expected a text in quotes.");
    return parse_ego_region(value.get<std::string>());
  } catch (const UsageError& error) {
    throw ConfigurationError(where + ": " + error.what());
  }
}

SequenceSettings apply_options(const SequenceOptions& options, SequenceSettings settings) {
  if (options.frames) settings.frames = *options.frames;
  if (options.poses) settings.poses = options.poses;
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
  if (options.label_rule) {
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
  if (has_file(file)) apply_file(file, settings);
  if (!defaults.name.empty()) settings.name = defaults.name;
  if (settings.name.empty()) settings.name = folder_name(folder);
  return apply_options(options, settings);
}

std::filesystem::path find_pose_file(const std::filesystem::path& folder, const std::string& name) {
  if (has_file(folder / name)) return folder / name;
  if (has_file(name)) return name;
  std::vector<std::string> there;
  for (const auto& path : list_files(folder, {".txt"})) there.push_back(path.filename().string());
  throw DataError(folder.string() + ": there is no pose file '" + name + "'; found " +
                  (there.empty() ? "no .txt file" : join(there)) +
                  ". Name one with --poses or \"poses\" in sequence.json.");
}

}  // namespace raymoval
