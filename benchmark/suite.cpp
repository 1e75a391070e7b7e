// SPDX-License-Identifier: MIT
#include "benchmark/suite.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "benchmark/suite_manifests.h"
#include "core/files.h"
#include "core/text.h"
#include "datasets/simulated/scene_text.h"
#include "eval/protocol.h"

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
    throw ConfigurationError(where + ": expected 0 <= min < max in metres.");
  }
  return range;
}

/// A path of a suite file: beside the file if it is there, else as it stands. `ROOT:05` names a
/// part of ROOT, so what follows the last colon does not count; names of built-in scenes stay.
std::string located(const std::string& path, const std::filesystem::path& folder) {
  const std::filesystem::path given(path);
  if (given.is_absolute() || path == "street") return path;
  if (path.find('/') == std::string::npos && names_scene(path)) return path;
  const std::filesystem::path beside = folder / given;
  const std::string text = beside.string();
  const std::size_t colon = text.rfind(':');
  std::error_code ignored;
  const bool there =
      std::filesystem::exists(beside, ignored) ||
      (colon != std::string::npos && std::filesystem::exists(text.substr(0, colon), ignored));
  return there ? text : path;
}

SequenceRequest sequence_of(const json& item, const std::filesystem::path& folder,
                            const std::string& where) {
  SequenceRequest request;
  if (item.is_string()) {
    request.path = located(item.get<std::string>(), folder);
    return request;
  }
  check_keys(item, {"path", "name", "frames", "poses", "label_rule", "range_m", "sensor"}, where);
  const auto path = text_of(item, "path", where);
  if (!path) throw ConfigurationError(where + ": 'path' is missing.");
  request.path = located(*path, folder);
  SequenceOptions& options = request.options;
  options.name = text_of(item, "name", where);
  options.poses = text_of(item, "poses", where);
  options.sensor = text_of(item, "sensor", where);
  if (const auto frames = text_of(item, "frames", where)) {
    options.frames = parse_frame_range(*frames);
  }
  if (const auto rule = text_of(item, "label_rule", where)) {
    options.label_rule = located(*rule, folder);
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

const std::vector<ParameterSpec>& protocol_parameters(const std::string& name) {
  std::vector<std::string> names;
  for (const ProtocolEntry& entry : protocol_entries()) {
    if (entry.name == name) return entry.parameters;
    names.push_back(entry.name);
  }
  throw UsageError("protocol '" + name + "' is unknown." + suggestion(name, names));
}

void read_method(const json& item, const std::string& where, const MethodRegistry& registry,
                 Suite& suite) {
  if (item.is_string()) {
    add_method(suite, item.get<std::string>(), "", registry);
    return;
  }
  check_keys(item, {"method", "set", "as"}, where);
  const auto name = text_of(item, "method", where);
  if (!name) throw ConfigurationError(where + ": 'method' is missing.");
  MethodRequest& added =
      add_method(suite, *name, text_of(item, "as", where).value_or(""), registry);
  if (item.contains("set")) {
    apply_object(item["set"], added.method.entry->name, where, added.method.entry->parameters,
                 added.method.configuration);
  }
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

void read_switches(const json& file, const std::string& where, Suite& suite) {
  if (file.contains("controls")) {
    if (!file["controls"].is_boolean()) throw_wrong_type(where, "controls", "true or false");
    suite.controls = file["controls"].get<bool>();
  }
  if (file.contains("threads")) {
    const json& threads = file["threads"];
    if (!threads.is_number_integer() || threads.get<std::int64_t>() < 1 ||
        threads.get<std::int64_t>() > 4096) {
      throw_wrong_type(where, "threads", "a whole number from 1 to 4096");
    }
    suite.threads = threads.get<int>();
  }
}

/// A name that appears in folders and tables.
void check_cell_name(const std::string& name) {
  const bool legal = !name.empty() && name.front() != '.' && name.size() <= 100 &&
                     std::all_of(name.begin(), name.end(), [](unsigned char c) {
                       return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                              (c >= 'a' && c <= 'z') || c == '-' || c == '_' || c == '.' ||
                              c == ':';
                     });
  if (!legal) {
    throw UsageError("'" + name +
                     "' cannot name a result: use letters, digits, '-', '_', '.' and ':'.");
  }
}

}  // namespace

Setting parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dot = equals == std::string::npos ? equals : text.rfind('.', equals);
  if (dot == std::string::npos || dot == 0 || dot + 1 == equals) {
    throw UsageError("--set " + text + ": expected METHOD.key=value, such as raymoval.tau0=0.2.");
  }
  return {text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1)};
}

Suite read_suite(const std::filesystem::path& path, const MethodRegistry& registry) {
  const json file = with_located_manifests(read_json(path), path.parent_path());
  const std::string where = path.string();
  check_keys(file, {"name", "sequences", "methods", "protocols", "controls", "threads"}, where);
  Suite suite;
  suite.name = text_of(file, "name", where).value_or(path.stem().string());
  const json& sequences = list_of(file, "sequences", where);
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    suite.sequences.push_back(
        sequence_of(sequences[i], path.parent_path(), place(where, "sequences", i)));
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
  if (suite.sequences.empty()) throw ConfigurationError(where + ": 'sequences' names none.");
  if (suite.methods.empty()) throw ConfigurationError(where + ": 'methods' names none.");
  return suite;
}

MethodRequest& add_method(Suite& suite, const std::string& name_and_variant, const std::string& as,
                          const MethodRegistry& registry) {
  MethodRequest request;
  request.method = registry.configure(name_and_variant);
  request.name = as.empty() ? request.method.full_name() : as;
  check_cell_name(request.name);
  for (const MethodRequest& known : suite.methods) {
    if (folder_name(known.name) == folder_name(request.name)) {
      throw UsageError("two methods of this run would be called '" + request.name +
                       "'. Leave one out, or give it another name with \"as\" in a suite file.");
    }
  }
  suite.methods.push_back(std::move(request));
  return suite.methods.back();
}

ProtocolRequest& add_protocol(Suite& suite, const std::string& protocol, const std::string& as) {
  ProtocolRequest request{as.empty() ? protocol : as, protocol, protocol_defaults(protocol)};
  check_cell_name(request.name);
  for (const ProtocolRequest& known : suite.protocols) {
    if (known.name == request.name) {
      throw UsageError("two protocols of this run would be called '" + request.name +
                       "'. Leave one out, or give it another name with \"as\" in a suite file.");
    }
  }
  suite.protocols.push_back(std::move(request));
  return suite.protocols.back();
}

namespace {

/// Sets `setting` where it names `target` of a method. @return whether it did
bool apply_setting(const Setting& setting, MethodRequest& request) {
  const MethodEntry& entry = *request.method.entry;
  const ParameterSpec& spec = find_parameter(entry.name, entry.parameters, setting.key);
  set_parameter(request.method.configuration, setting.key,
                checked_value_from_text(entry.name, spec, setting.value));
  return true;
}

void check_given_once(const std::vector<Setting>& settings) {
  for (std::size_t i = 0; i < settings.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (settings[i].target == settings[j].target && settings[i].key == settings[j].key) {
        throw UsageError("--set gives " + settings[i].target + "." + settings[i].key +
                         " twice; leave one out.");
      }
    }
  }
}

}  // namespace

void apply_settings(Suite& suite, const std::vector<Setting>& settings) {
  check_given_once(settings);
  std::vector<bool> used(settings.size(), false);
  for (MethodRequest& request : suite.methods) {
    // The method's own settings first, so that one for a variant or a cell wins in any order.
    for (const bool whole_method : {true, false}) {
      for (std::size_t i = 0; i < settings.size(); ++i) {
        const bool names_method = settings[i].target == request.method.entry->name;
        const bool names_cell = !names_method && (settings[i].target == request.name ||
                                                  settings[i].target == request.method.full_name());
        if (whole_method ? names_method : names_cell) {
          used[i] = apply_setting(settings[i], request) || used[i];
        }
      }
    }
  }
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (used[i]) continue;
    std::vector<std::string> names;
    for (const MethodRequest& request : suite.methods) {
      names.push_back(request.method.entry->name);
      names.push_back(request.name);
    }
    throw UsageError("--set names '" + settings[i].target + "', which is not in this run." +
                     suggestion(settings[i].target, names));
  }
}

const std::vector<std::string>& control_names() {
  static const std::vector<std::string> names = {"noop", "remove-all", "oracle"};
  return names;
}

bool is_control(const std::string& method) {
  const auto& names = control_names();
  return std::find(names.begin(), names.end(), method) != names.end();
}

void add_controls(Suite& suite, const MethodRegistry& registry) {
  std::vector<MethodRequest> listed = std::move(suite.methods);
  suite.methods.clear();
  for (const std::string& control : control_names()) {
    const bool there = std::any_of(listed.begin(), listed.end(), [&](const MethodRequest& request) {
      return request.method.entry->name == control;
    });
    if (!there) add_method(suite, control, "", registry);
  }
  for (MethodRequest& request : listed) suite.methods.push_back(std::move(request));
}

std::string folder_name(const std::string& name) {
  std::string folder;
  for (const char c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       c == '-' || c == '_' || c == '.';
    folder += plain ? c : (c == ':' ? '-' : '_');
  }
  if (folder.empty() || folder.front() == '.') folder.insert(0, "_");
  return folder;
}

}  // namespace raymoval
