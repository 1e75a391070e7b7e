// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>
#include <optional>

#include "benchmark/suite/suite.h"
#include "benchmark/suite/suite_manifests.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/settings.h"

namespace raymoval {
namespace {

using nlohmann::json;

/// "suite.json: sequences[2]".
std::string place(const std::string& where, const char* list, std::size_t index) {
  return where + ": " + list + "[" + std::to_string(index) + "]";
}

[[noreturn]] void throw_wrong_type(const std::string& where, const char* key,
                                   const char* expected) {
  throw ConfigurationError(where + ": '" + key + "' must be " + expected + ".");
}

std::optional<std::string> text_of(const json& object, const char* key, const std::string& where) {
  if (!object.contains(key)) return std::nullopt;
  if (!object[key].is_string()) throw_wrong_type(where, key, "a text");
  return object[key].get<std::string>();
}

const json& list_of(const json& object, const char* key, const std::string& where) {
  static const json empty = json::array();
  if (!object.contains(key)) return empty;
  if (!object[key].is_array()) throw_wrong_type(where, key, "a list [ ... ]");
  return object[key];
}

RangeLimits range_of(const json& object, const std::string& where) {
  check_keys(object, {"min", "max"}, where);
  RangeLimits range;
  for (const auto& [key, value] : object.items()) {
    if (!value.is_number()) throw_wrong_type(where, key.c_str(), "a number of metres");
    (key == "min" ? range.min : range.max) = value.get<double>();
  }
  if (!(range.min >= 0.0 && range.max > range.min)) {
    throw ConfigurationError(where + ": expected 0 <= min < max in metres, but min is " +
                             number_text(range.min) + " and max " + number_text(range.max) + ".");
  }
  return range;
}

/// Where the paths of a suite file lead.
struct Places {
  std::filesystem::path folder;  ///< Of the file.
  std::string data;              ///< What "{data}" stands for.
  bool data_used = false;
};

constexpr std::string_view kData = "{data}";

/// A path of a suite file: beside the file if it is there, else as it stands. `ROOT:05` names a
/// part of ROOT, so what follows the last colon does not count; names of built-in scenes stay.
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

/// The path of a sequence. A scene is only one where no folder of its name stands beside the file.
std::string sequence_path(const std::string& path, Places& places, const std::string& where) {
  const std::string both = scene_or_folder(path, places.folder);
  if (!both.empty()) throw ConfigurationError(where + ": " + both);
  return located(path, places);
}

SequenceRequest sequence_of(const json& item, Places& places, const std::string& where) {
  SequenceRequest request;
  if (item.is_string()) {
    request.path = sequence_path(item.get<std::string>(), places, where);
    return request;
  }
  check_keys(
      item,
      {"path", "name", "frames", "poses", "label_rule", "range_m", "sensor", "up", "drop_ego"},
      where);
  const auto path = text_of(item, "path", where);
  if (!path) throw ConfigurationError(where + ": 'path' is missing.");
  request.path = sequence_path(*path, places, where);
  SequenceOptions& options = request.options;
  options.name = text_of(item, "name", where);
  options.poses = text_of(item, "poses", where);
  options.sensor = text_of(item, "sensor", where);
  options.up = text_of(item, "up", where);
  if (const auto frames = text_of(item, "frames", where)) {
    options.frames = parse_frame_range(*frames);
  }
  if (const auto rule = text_of(item, "label_rule", where)) {
    options.label_rule = located(*rule, places);
  }
  if (item.contains("drop_ego")) {
    options.drop_ego = ego_region_value(item["drop_ego"], where + ".drop_ego");
  }
  if (item.contains("range_m")) options.range_m = range_of(item["range_m"], where + ".range_m");
  return request;
}

/// Puts the values of a "set" object into `configuration`.
void apply_object(const json& object, const std::string& owner, const std::string& where,
                  const std::vector<ParameterSpec>& specs, Configuration& configuration) {
  if (!object.is_object()) throw_wrong_type(where, "set", "an object { \"key\": value }");
  for (const auto& [key, value] : object.items()) {
    try {
      const ParameterSpec& spec = find_parameter(owner, specs, key);
      set_parameter(configuration, key, checked_value(owner, spec, value));
    } catch (const ConfigurationError& error) {
      throw ConfigurationError(where + ": " + error.what());
    }
  }
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
    check_keys(value, {"sweep"}, where + ".set." + key);
    if (!value.contains("sweep") || !value["sweep"].is_array() || value["sweep"].empty()) {
      throw_wrong_type(where + ".set." + key, "sweep", "a list of values [ ... ]");
    }
    std::vector<SweepPoint> longer;
    for (const SweepPoint& point : points) {
      for (const json& one : value["sweep"]) {
        longer.push_back(point);
        longer.back().emplace_back(key, one);
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

/// "raymoval:online:tau0=0.2,tau1=0.3"
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
    ConfiguredMethod method = registry.configure(name);
    const MethodEntry& entry = *method.entry;
    Configuration values;
    json together = plain;
    for (const auto& [key, value] : point) {
      together[key] = value;
      values.emplace_back(
          key, checked_value(entry.name, find_parameter(entry.name, entry.parameters, key), value));
    }
    const std::string base = as.empty() ? method.full_name() : as;
    MethodRequest& added =
        add_method(suite, name, values.empty() ? as : point_name(base, values), registry);
    apply_object(together, entry.name, where, entry.parameters, added.method.configuration);
    for (const auto& [key, value] : together.items()) added.given.push_back(key);
    if (values.empty()) continue;
    added.sweep_of = base;
    added.sweep = values;
  }
}

void read_method(const json& item, const std::string& where, const MethodRegistry& registry,
                 Suite& suite) {
  if (item.is_string()) {
    for (const std::string& name : expanded_methods(item.get<std::string>(), registry)) {
      add_method(suite, name, "", registry);
    }
    return;
  }
  check_keys(item, {"method", "set", "as"}, where);
  const auto name = text_of(item, "method", where);
  if (!name) throw ConfigurationError(where + ": 'method' is missing.");
  const json set = item.value("set", json::object());
  if (!set.is_object()) throw_wrong_type(where, "set", "an object { \"key\": value }");
  const std::vector<std::string> names = expanded_methods(*name, registry);
  const std::string as = text_of(item, "as", where).value_or("");
  if (names.size() > 1 && !as.empty()) {
    throw ConfigurationError(where + ": 'as' names one method, but " + *name + " stands for " +
                             std::to_string(names.size()) + ". Leave it out.");
  }
  for (const std::string& one : names) add_points(one, as, set, where, registry, suite);
}

void read_protocol(const json& item, const std::string& where, Suite& suite) {
  if (item.is_string()) {
    add_protocol(suite, item.get<std::string>(), "");
    return;
  }
  check_keys(item, {"protocol", "set", "as"}, where);
  const auto name = text_of(item, "protocol", where);
  if (!name) throw ConfigurationError(where + ": 'protocol' is missing.");
  ProtocolRequest& added = add_protocol(suite, *name, text_of(item, "as", where).value_or(""));
  if (item.contains("set")) {
    apply_object(item["set"], added.protocol, where, protocol_parameters(added.protocol),
                 added.options);
  }
}

int count_of(const json& file, const char* key, int most, const std::string& where) {
  const json& value = file[key];
  if (!value.is_number_integer() || value.get<std::int64_t>() < 1 ||
      value.get<std::int64_t>() > most) {
    throw_wrong_type(where, key, ("a whole number from 1 to " + std::to_string(most)).c_str());
  }
  return value.get<int>();
}

double limit_of(const json& file, const char* key, const std::string& where) {
  if (!file.contains(key)) return 0.0;
  if (!file[key].is_number() || !(file[key].get<double>() > 0.0)) {
    throw_wrong_type(where, key, "a number greater than 0");
  }
  return file[key].get<double>();
}

void read_switches(const json& file, const std::string& where, Suite& suite) {
  if (file.contains("controls")) {
    if (!file["controls"].is_boolean()) throw_wrong_type(where, "controls", "true or false");
    suite.controls = file["controls"].get<bool>();
  }
  if (file.contains("threads")) suite.threads = count_of(file, "threads", 4096, where);
  if (file.contains("repeats")) suite.repeats = count_of(file, "repeats", 1000, where);
  suite.time_limit_s = limit_of(file, "time_limit_s", where);
  suite.memory_limit_mib = limit_of(file, "memory_limit_mib", where);
}

}  // namespace

Suite read_suite(const std::filesystem::path& path, const MethodRegistry& registry,
                 const std::string& data) {
  const json file = with_located_manifests(read_json(path), path.parent_path());
  const std::string where = path.string();
  check_keys(file,
             {"name", "sequences", "methods", "protocols", "controls", "threads", "repeats",
              "time_limit_s", "memory_limit_mib"},
             where);
  Suite suite;
  Places places{path.parent_path(), data};
  suite.name = text_of(file, "name", where).value_or(path.stem().string());
  const json& sequences = list_of(file, "sequences", where);
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    suite.sequences.push_back(sequence_of(sequences[i], places, place(where, "sequences", i)));
  }
  const json& methods = list_of(file, "methods", where);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    read_method(methods[i], place(where, "methods", i), registry, suite);
  }
  const json& protocols = list_of(file, "protocols", where);
  for (std::size_t i = 0; i < protocols.size(); ++i) {
    read_protocol(protocols[i], place(where, "protocols", i), suite);
  }
  read_switches(file, where, suite);
  if (places.data_used != !data.empty()) {
    throw UsageError(places.data_used
                         ? where + ": this suite runs on data of yours: say where with --data ROOT."
                         : where +
                               ": --data is given, but no path of this suite begins with "
                               "{data}.");
  }
  if (suite.sequences.empty()) throw ConfigurationError(where + ": 'sequences' names none.");
  if (suite.methods.empty()) throw ConfigurationError(where + ": 'methods' names none.");
  return suite;
}

}  // namespace raymoval
