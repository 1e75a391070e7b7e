// SPDX-License-Identifier: MIT
#include "benchmark/suite/suite_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "benchmark/suite/reading_options.h"
#include "core/files/fields.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/name.h"
#include "core/text.h"
#include "datasets/ego/sensor_places.h"
#include "datasets/open_sequence.h"
#include "datasets/settings.h"
#include "eval/protocol_registry.h"
#include "methods/external/external.h"

namespace raymoval {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// A suite file.

std::optional<std::string> text_of(const Fields& object, const char* key) {
  return object.has(key) ? std::optional(object.text(key, "")) : std::nullopt;
}

RangeLimits range_of(const Fields& object) {
  RangeLimits range;
  range.min = object.number("min", range.min);
  range.max = object.number("max", range.max);
  if (range.min >= 0.0 && range.max > range.min) return range;
  throw ConfigurationError(
      fmt::format("{}: expected 0 <= min < max in metres, but min is {} and max {}.",
                  object.where(), number_text(range.min), number_text(range.max)));
}

/// The folders that paths of a suite file refer to.
struct Places {
  std::filesystem::path folder;  ///< Of the file.
  std::string data;              ///< The value of "{data}".
  bool data_used = false;
};

constexpr std::string_view kData = "{data}";

/// A path of a suite file: beside the file if it exists there, else unchanged. `ROOT:05` is a part
/// of ROOT, so the text after the last colon is ignored in the check. Names of built-in scenes are
/// not changed.
std::string located(const std::string& path, Places& places) {
  if (path.starts_with(kData)) {
    places.data_used = true;
    return places.data + path.substr(kData.size());
  }
  const std::filesystem::path given(path);
  if (given.is_absolute()) return path;
  if (path.find('/') == std::string::npos && is_scene(path)) return path;
  const std::filesystem::path beside = places.folder / given;
  const std::string text = beside.string();
  const std::size_t colon = text.rfind(':');
  const bool there =
      is_there(beside) || (colon != std::string::npos && is_there(text.substr(0, colon)));
  return there ? text : path;
}

/// "external:PATH" with the path of a manifest beside the suite file, if it exists; names of other
/// methods are not changed.
std::string located_method(const std::string& name, const Places& places) {
  const auto manifest = external_manifest(name);
  if (!manifest || !has_file(places.folder / *manifest)) return name;
  return "external:" + (places.folder / *manifest).string();
}

/// The path of a sequence.
/// @throws ConfigurationError if it names both a scene and a folder beside the file
std::string sequence_path(const std::string& path, Places& places, const std::string& where) {
  const std::string both = scene_or_folder(path, places.folder);
  if (!both.empty()) throw ConfigurationError(where + ": " + both);
  return located(path, places);
}

/// Sets a reading option by its key in a file, such as "pose_format" or "max_gap_s".
void set_option(const std::string& key, const std::string& text, SequenceOptions& options) {
  std::string name = key.ends_with("_s") ? key.substr(0, key.size() - 2) : key;
  std::replace(name.begin(), name.end(), '_', '-');
  for (const ReadingOption& option : reading_options()) {
    if (option.name == name) option.set(options, key, text);
  }
}

SequenceRequest sequence_of(const json& item, Places& places, const std::string& where) {
  if (item.is_string()) return {sequence_path(item.get<std::string>(), places, where), {}};
  const Fields object(item, where,
                      "path name frames poses topic pose_topic label_rule range_m sensor up "
                      "drop_ego point_layout pose_format "
                      "T_sensor sensor_origin time_offset_s max_gap_s points deskew "
                      "point_time_unit skip_bad_scans");
  SequenceRequest request{sequence_path(object.text("path"), places, where), {}};
  SequenceOptions& options = request.options;
  for (const char* key :
       {"name", "frames", "poses", "topic", "pose_topic", "sensor", "up", "point_layout",
        "pose_format", "T_sensor", "sensor_origin", "point_time_unit"}) {
    if (object.has(key)) set_option(key, object.text(key), options);
  }
  if (const auto rule = text_of(object, "label_rule")) {
    options.label_rule = is_rule_file(*rule) ? located(*rule, places) : *rule;
  }
  if (object.has("drop_ego")) {
    options.drop_ego = ego_region_value(object.member("drop_ego"), where + ".drop_ego");
  }
  if (object.has("time_offset_s")) options.time_offset_s = object.number("time_offset_s", 0.0);
  if (object.has("max_gap_s")) options.max_gap_s = object.positive("max_gap_s", 1.0);
  if (object.has("deskew")) options.deskew = object.flag("deskew", false);
  options.skip_bad_scans = object.flag("skip_bad_scans", false);
  if (const auto points = text_of(object, "points")) {
    options.points = parse_point_frame(object.place("points"), *points);
  }
  if (object.has("range_m")) {
    options.range_m = range_of(Fields(object.member("range_m"), where + ".range_m", "min max"));
  }
  return request;
}

/// Stores the values of a "set" object in `configuration`.
void apply_object(const json& object, const std::string& owner, const std::string& where,
                  const std::vector<ParameterSpec>& specs, Configuration& configuration) {
  for (const auto& [key, value] : object.items()) {
    try {
      const ParameterSpec& spec = find_parameter(owner, specs, key);
      set_parameter(configuration, key, checked_value(owner, spec, value));
    } catch (const ConfigurationError& error) {
      throw ConfigurationError(where + ": " + error.what());
    }
  }
}

/// The values of the "set" object; none if there is no such object.
json set_of(const Fields& item) {
  if (!item.has("set")) return json::object();
  if (!item.member("set").is_object()) item.fail("set", "an object { \"key\": value }");
  return item.member("set");
}

/// A point of a sweep: a value of each swept parameter, in the order of the file.
using SweepPoint = std::vector<std::pair<std::string, json>>;

bool is_sweep(const json& value) {
  return value.is_object();
}

/// All combinations of the swept values in `set`; one empty point if none is swept.
std::vector<SweepPoint> sweep_points(const json& set, const std::string& where) {
  constexpr std::size_t kMostPoints = 1000;
  std::vector<SweepPoint> points = {{}};
  for (const auto& [key, value] : set.items()) {
    if (!is_sweep(value)) continue;
    const Fields sweep(value, where + ".set." + key, "sweep");
    const auto swept = sweep.list("sweep");
    if (swept.empty()) sweep.fail("sweep", "a list of values [ ... ]");
    std::vector<SweepPoint> longer;
    for (const SweepPoint& point : points) {
      for (const auto& [one, place] : swept) {
        longer.push_back(point);
        longer.back().emplace_back(key, *one);
      }
    }
    points = std::move(longer);
    if (points.size() > kMostPoints) {
      throw ConfigurationError(where + ": the sweep has more than " + std::to_string(kMostPoints) +
                               " points; split it.");
    }
  }
  return points;
}

/// "raymoval:online:tau1=0.3,voxel_size=0.1"
std::string point_name(const std::string& base, const Configuration& point) {
  std::vector<std::string> parts;
  for (const auto& [key, value] : point) parts.push_back(key + "=" + parameter_text(value));
  return base + ":" + join(parts, ",");
}

/// Adds one method, or one for each point of a sweep.
void add_points(const std::string& name, const std::string& as, const json& set,
                const std::string& where, const MethodRegistry& registry, Suite& suite) {
  json plain = json::object();
  for (const auto& [key, value] : set.items()) {
    if (!is_sweep(value)) plain[key] = value;
  }
  for (const SweepPoint& point : sweep_points(set, where)) {
    MethodRequest request{"", registry.configure(name)};
    const MethodEntry& entry = *request.method.entry;
    json together = plain;
    for (const auto& [key, value] : point) {
      together[key] = value;
      request.sweep.emplace_back(
          key, checked_value(entry.name, find_parameter(entry.name, entry.parameters, key), value));
    }
    apply_object(together, entry.name, where, entry.parameters, request.method.configuration);
    for (const auto& [key, value] : together.items()) request.given.push_back(key);
    const std::string base = as.empty() ? request.method.full_name() : as;
    request.name = base;
    if (!request.sweep.empty()) {
      request.sweep_of = base;
      request.name = point_name(base, request.sweep);
    }
    add_request(suite, std::move(request));
  }
}

void read_method(const json& item, const std::string& where, const Places& places,
                 const MethodRegistry& registry, Suite& suite) {
  if (item.is_string()) {
    const std::string name = located_method(item.get<std::string>(), places);
    for (const std::string& one : expanded_methods(name, registry)) {
      add_method(suite, one, "", registry);
    }
    return;
  }
  const Fields object(item, where, "method set as");
  const std::string name = located_method(object.text("method"), places);
  const std::vector<std::string> names = expanded_methods(name, registry);
  const std::string as = object.text("as", "");
  if (names.size() > 1 && !as.empty()) {
    throw ConfigurationError(
        fmt::format("{}: 'as' names one method, but {} stands for {}. Leave it out.", where, name,
                    names.size()));
  }
  const json set = set_of(object);
  for (const std::string& one : names) add_points(one, as, set, where, registry, suite);
}

void read_protocol(const json& item, const std::string& where, Suite& suite) {
  if (item.is_string()) {
    add_protocol(suite, item.get<std::string>(), "");
    return;
  }
  const Fields object(item, where, "protocol set as");
  ProtocolRequest& added = add_protocol(suite, object.text("protocol"), object.text("as", ""));
  apply_object(set_of(object), added.protocol, where, protocol_entry(added.protocol).parameters,
               added.options);
}

/// @param what such as "path of a sequence"
void check_is_utf8(const std::string& text, const std::string& what) {
  try {
    (void)json(text).dump();
  } catch (const json::type_error&) {
    throw UsageError(fmt::format(
        "{} '{}': is not UTF-8, as run.json and the processes of methods need it. Rename the "
        "folder or file, or make a link to it (ln -s) and give the whole path of the link.",
        what, text));
  }
}

/// Checks that --data is given exactly if the suite uses "{data}".
void check_data_given(const Places& places, const std::string& where) {
  if (places.data_used == !places.data.empty()) return;
  throw UsageError(where +
                   (places.data_used
                        ? ": this suite runs on your own data: name its folder with --data ROOT."
                        : ": --data is given, but no path of this suite begins with {data}."));
}

}  // namespace

Suite read_suite(const std::filesystem::path& path, const MethodRegistry& registry,
                 const std::string& data) {
  const json content = read_json(path);
  const Fields file(
      content, path.string(),
      "name sequences methods protocols controls threads time_limit_s memory_limit_mib");
  Suite suite;
  Places places{path.parent_path(), data};
  suite.name = file.text("name", path.stem().string());
  if (const std::string problem = name_problem(suite.name); !problem.empty()) {
    throw ConfigurationError(fmt::format("{}: the name '{}' of the suite {}; expected {}.",
                                         file.where(), suite.name, problem, kNameForm));
  }
  for (const auto& [item, where] : file.list("sequences")) {
    suite.sequences.push_back(sequence_of(*item, places, where));
  }
  for (const auto& [item, where] : file.list("methods")) {
    read_method(*item, where, places, registry, suite);
  }
  for (const auto& [item, where] : file.list("protocols")) read_protocol(*item, where, suite);
  suite.controls = file.flag("controls", suite.controls);
  suite.threads = file.integer("threads", suite.threads, 1, 4096);
  suite.time_limit_s = file.positive("time_limit_s", suite.time_limit_s);
  suite.memory_limit_mib = file.positive("memory_limit_mib", suite.memory_limit_mib);
  check_data_given(places, file.where());
  if (suite.sequences.empty()) throw ConfigurationError(file.where() + ": 'sequences' is empty.");
  if (suite.methods.empty()) throw ConfigurationError(file.where() + ": 'methods' is empty.");
  return suite;
}

// A place.

ordered_json to_json(const SequenceRequest& place) {
  const SequenceOptions& options = place.options;
  ordered_json json = {{"path", place.path}};
  const auto add = [&json](const char* key, const std::optional<std::string>& text) {
    if (text) json[key] = *text;
  };
  if (options.frames) add("frames", frame_range_text(*options.frames));
  add("poses", options.poses);
  add("topic", options.topic);
  add("pose_topic", options.pose_topic);
  if (options.label_rule) add("label_rule", options.label_rule->string());
  add("sensor", options.sensor);
  add("up", options.up);
  add("point_layout", options.point_layout);
  if (options.drop_ego) add("drop_ego", ego_region_text(*options.drop_ego));
  add("name", options.name);
  add("pose_format", options.pose_format);
  add("T_sensor", options.T_sensor);
  if (options.sensor_origin) add("sensor_origin", sensor_places_text(*options.sensor_origin));
  add("point_time_unit", options.point_time_unit);
  if (options.time_offset_s) add("time_offset_s", number_text(*options.time_offset_s));
  if (options.max_gap_s) add("max_gap_s", number_text(*options.max_gap_s));
  if (options.points) add("points", *options.points == PointFrame::kWorld ? "world" : "sensor");
  if (options.deskew) add("deskew", *options.deskew ? "true" : "false");
  if (options.skip_bad_scans) add("skip_bad_scans", "true");
  if (!options.range_m) return json;
  add("range_min", number_text(options.range_m->min));  // A text: the limit may be infinite.
  add("range_max", number_text(options.range_m->max));
  return json;
}

SequenceRequest place_from(const ordered_json& json) {
  SequenceRequest place;
  place.path = json.at("path").get<std::string>();
  SequenceOptions& options = place.options;
  for (const auto& [key, value] : json.items()) {
    const auto text = value.get<std::string>();
    if (key == "deskew") {
      options.deskew = text == "true";
      continue;
    }
    set_option(key, text, options);
    if (!key.starts_with("range_")) continue;
    if (!options.range_m) options.range_m.emplace();
    const double metres = parse_number<double>(text).value();
    (key == "range_min" ? options.range_m->min : options.range_m->max) = metres;
  }
  return place;
}

void check_paths_fit_json(const Suite& suite) {
  for (const SequenceRequest& request : suite.sequences) {
    const ordered_json place = to_json(absolute_place(request));
    for (const auto& [key, text] : place.items()) {
      check_is_utf8(text.get<std::string>(), key + " of a sequence");
    }
  }
  for (const MethodRequest& request : suite.methods) {
    check_is_utf8(request.method.address(), "method");
  }
}

}  // namespace raymoval
