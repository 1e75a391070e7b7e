// SPDX-License-Identifier: MIT
#include "benchmark/suite/suite.h"

#include <algorithm>

#include "core/files/file_kind.h"
#include "core/name.h"
#include "core/parameter_condition.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

const std::pair<std::string, KnownAnswer> kControls[] = {
    {"noop", KnownAnswer::kNothingRemoved},
    {"remove-all", KnownAnswer::kEverythingRemoved},
    {"oracle", KnownAnswer::kMovingPointsRemoved}};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether a folder may have this character in its name.
bool is_plain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
         std::string_view("-_.=,+").find(c) != std::string_view::npos;
}

/// Checks a name that appears in folders and tables.
void check_cell_name(const std::string& name) {
  const bool legal = name_problem(name).empty() && name.size() <= 100 &&
                     std::ranges::all_of(name, [](char c) { return c == ':' || is_plain(c); });
  if (!legal) {
    throw UsageError("'" + name +
                     "' cannot name a result: use at most 100 letters, digits and any of - _ . : = "
                     ", +, and begin with a letter, a digit or _.");
  }
}

[[noreturn]] void throw_same_name(const std::string& what, const std::string& name) {
  throw UsageError(
      "two " + what + " of this run would be called '" + name +
      "'. Leave one out, or give it another name with \"as\" in a suite file or --as.");
}

/// Puts a '*' behind the name of a variant whose parameters were changed. A name from "as" is not
/// changed.
void mark_changed(MethodRequest& request) {
  const std::string plain = request.method.full_name();
  const std::string base = request.sweep_of.empty() ? request.name : request.sweep_of;
  if (base != plain && base != plain + "*") return;
  const std::string marked = plain + (request.changed_from().empty() ? "" : "*");
  request.name.replace(0, base.size(), marked);
  if (!request.sweep_of.empty()) request.sweep_of = marked;
}

/// @throws UsageError if one of the first `count` methods has the name, or a name with its folder
void check_name_is_free(const Suite& suite, std::size_t count, const std::string& name) {
  for (std::size_t i = 0; i < count; ++i) {
    if (folder_name(suite.methods[i].name) == folder_name(name)) throw_same_name("methods", name);
  }
}

/// Whether the path is a built-in scene, such as "town" or "town:scans=60".
bool is_built_in(const std::string& path) {
  const std::string name = path.substr(0, path.find(':'));
  return contains(scene_names(), name);
}

}  // namespace

Configuration MethodRequest::changed_from() const {
  Configuration changed = method.changed_from();
  std::erase_if(changed, [&](const auto& usual) {
    return std::ranges::any_of(sweep,
                               [&](const auto& swept) { return swept.first == usual.first; });
  });
  return changed;
}

Setting parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dot = equals == std::string::npos ? equals : text.rfind('.', equals);
  if (dot == std::string::npos || dot == 0 || dot + 1 == equals) {
    throw UsageError("--set " + text +
                     ": expected METHOD.key=value, such as raymoval.voxel_size=0.1, or "
                     "protocol:NAME.key=value, such as protocol:erasor.lift=0.");
  }
  return {text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1)};
}

SequenceRequest absolute_place(const SequenceRequest& place) {
  SequenceRequest absolute = place;
  const auto make_absolute = [&](const std::filesystem::path& path) {
    std::error_code error;
    const auto made = std::filesystem::absolute(path, error);
    if (!error) return made.lexically_normal();
    throw DataError(path.string() + ": cannot be made absolute (" + error.message() + ").");
  };
  if (!is_built_in(place.path)) absolute.path = make_absolute(place.path).string();
  SequenceOptions& options = absolute.options;
  // A pose file may also be a name in the sequence folder.
  if (options.poses && has_file(*options.poses)) {
    options.poses = make_absolute(*options.poses).string();
  }
  if (options.label_rule && is_rule_file(*options.label_rule)) {
    options.label_rule = make_absolute(*options.label_rule);
  }
  return absolute;
}

MethodRequest& add_method(Suite& suite, const std::string& name_and_variant, const std::string& as,
                          const MethodRegistry& registry) {
  if (const auto names = expanded_methods(name_and_variant, registry);
      names != std::vector{name_and_variant}) {
    throw UsageError("method '" + name_and_variant + "' stands for " +
                     counted_text(names.size(), "method") +
                     ", and one is expected here: " + join(names) + ".");
  }
  const ConfiguredMethod method = registry.configure(name_and_variant);
  add_request(suite, {as.empty() ? method.full_name() : as, method});
  return suite.methods.back();
}

void add_request(Suite& suite, MethodRequest request) {
  check_cell_name(request.name);
  mark_changed(request);
  check_name_is_free(suite, suite.methods.size(), request.name);
  suite.methods.push_back(std::move(request));
}

std::vector<std::string> expanded_methods(const std::string& name, const MethodRegistry& registry) {
  constexpr std::string_view kAllVariants = ":all";
  std::vector<std::string> names;
  if (name == "all") {
    for (const auto& entry : registry.entries()) {
      if (!is_control(entry->name)) {
        names.push_back(entry->name + ":" + entry->variants.front().name);
      }
    }
    return names;
  }
  if (name.starts_with("external:") || !name.ends_with(kAllVariants)) return {name};
  const MethodEntry& entry = registry.find(name.substr(0, name.size() - kAllVariants.size()));
  for (const MethodVariant& variant : entry.variants) {
    names.push_back(entry.name + ":" + variant.name);
  }
  return names;
}

ProtocolRequest& add_protocol(Suite& suite, const std::string& protocol, const std::string& as) {
  ProtocolRequest request{as.empty() ? protocol : as, protocol, protocol_defaults(protocol)};
  check_cell_name(request.name);
  for (const ProtocolRequest& known : suite.protocols) {
    if (known.name == request.name) throw_same_name("protocols", request.name);
  }
  suite.protocols.push_back(std::move(request));
  return suite.protocols.back();
}

namespace {

/// Sets the parameter of a method that `setting` names. @throws UsageError if the suite sweeps it
void apply_setting(const Setting& setting, MethodRequest& request) {
  const MethodEntry& entry = *request.method.entry;
  const ParameterSpec& spec = find_parameter(entry.name, entry.parameters, setting.key);
  for (const auto& [key, value] : request.sweep) {
    if (key != setting.key) continue;
    throw UsageError("--set " + setting.target + "." + key + ": the suite sweeps this parameter; " +
                     "leave one out.");
  }
  set_parameter(request.method.configuration, setting.key,
                checked_value_from_text(entry.name, spec, setting.value));
  if (!contains(request.given, setting.key)) request.given.push_back(setting.key);
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

/// Suggests valid targets of settings that are similar to `given`.
[[noreturn]] void throw_no_target(const Suite& suite, const std::string& given) {
  std::vector<std::string> names;
  for (const MethodRequest& request : suite.methods) {
    names.push_back(request.method.entry->name);
    names.push_back(request.name);
  }
  for (const ProtocolRequest& request : suite.protocols) {
    names.push_back(std::string(kProtocolPrefix) + request.name);
    if (request.name != given) continue;
    throw UsageError("--set names '" + given +
                     "', which is not a method of this run but a protocol: " + "write " +
                     names.back() + ".key=value.");
  }
  throw UsageError("--set names '" + given + "', which is not in this run." +
                   suggestion(given, names));
}

/// Values that are each in range may still not fit together, which only the method checks.
/// @throws ConfigurationError of the method
void check_values_fit(const Suite& suite) {
  for (const MethodRequest& request : suite.methods) {
    const MethodEntry& entry = *request.method.entry;
    // Controls that need labels and external programs are made where they run.
    if (!entry.needs_truth && entry.manifest.empty()) (void)request.method.make();
  }
}

}  // namespace

void apply_settings(Suite& suite, const std::vector<Setting>& settings) {
  check_given_once(settings);
  std::vector<bool> used(settings.size(), false);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (!settings[i].target.starts_with(kProtocolPrefix)) continue;
    set_protocol_option(suite.protocols, settings[i]);
    used[i] = true;
  }
  for (MethodRequest& request : suite.methods) {
    // Settings for a whole method come first, so that one for a variant or a cell wins in any
    // order.
    for (const bool whole_method : {true, false}) {
      for (std::size_t i = 0; i < settings.size(); ++i) {
        const bool names_method = settings[i].target == request.method.entry->name;
        const bool names_cell = !names_method && (settings[i].target == request.name ||
                                                  settings[i].target == request.method.full_name());
        if (whole_method ? !names_method : !names_cell) continue;
        apply_setting(settings[i], request);
        used[i] = true;
      }
    }
  }
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (!used[i]) throw_no_target(suite, settings[i].target);
  }
  for (MethodRequest& request : suite.methods) mark_changed(request);
  for (std::size_t i = 0; i < suite.methods.size(); ++i) {
    check_name_is_free(suite, i, suite.methods[i].name);
  }
  check_values_fit(suite);
}

std::vector<std::string> settings_without_effect(const Suite& suite) {
  const auto lines_of = [](const MethodRequest& request, const std::string& name) {
    std::string owner = request.sweep_of.empty() ? request.name : request.sweep_of;
    std::erase(owner, '*');
    return without_effect(owner, request.method.entry->parameters, request.method.configuration,
                          {name});
  };
  std::vector<std::string> lines;
  for (const MethodRequest& request : suite.methods) {
    for (const std::string& name : request.given) {
      const auto acts_at = [&](const MethodRequest& point) {
        return point.sweep_of == request.sweep_of && contains(point.given, name) &&
               lines_of(point, name).empty();
      };
      if (!request.sweep_of.empty() &&
          std::any_of(suite.methods.begin(), suite.methods.end(), acts_at)) {
        continue;
      }
      for (const std::string& line : lines_of(request, name)) {
        if (!contains(lines, line)) lines.push_back(line);
      }
    }
  }
  return lines;
}

void set_protocol_option(std::vector<ProtocolRequest>& protocols, const Setting& setting) {
  const std::string target = without_protocol_prefix(setting.target);
  std::vector<std::string> names;
  for (ProtocolRequest& request : protocols) {
    names.push_back(request.name);
    if (request.name != target) continue;
    const std::string owner = "protocol " + request.protocol;
    const ParameterSpec& spec =
        find_parameter(owner, protocol_entry(request.protocol).parameters, setting.key);
    set_parameter(request.options, setting.key,
                  checked_value_from_text(owner, spec, setting.value));
    return;
  }
  throw UsageError("--set names '" + setting.target + "', which is not a requested protocol." +
                   suggestion(target, names));
}

bool is_control(const std::string& method) {
  return known_answer(method).has_value();
}

void add_controls(Suite& suite, const MethodRegistry& registry) {
  std::vector<MethodRequest> listed = std::move(suite.methods);
  suite.methods.clear();
  for (const auto& [control, answer] : kControls) {
    const bool there = std::any_of(listed.begin(), listed.end(), [&](const MethodRequest& request) {
      return request.method.entry->name == control;
    });
    if (!there) add_method(suite, control, "", registry);
  }
  for (MethodRequest& request : listed) suite.methods.push_back(std::move(request));
}

std::string folder_name(const std::string& name) {
  std::string folder;
  for (const char c : name) folder += is_plain(c) ? c : (c == ':' ? '-' : '_');
  if (folder.empty() || folder.front() == '.') folder.insert(0, "_");
  return folder;
}

std::optional<KnownAnswer> known_answer(const std::string& method) {
  for (const auto& [control, answer] : kControls) {
    if (control == method) return answer;
  }
  return std::nullopt;
}

}  // namespace raymoval
