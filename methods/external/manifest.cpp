// SPDX-License-Identifier: MIT
#include "methods/external/manifest.h"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/files/fields.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/name.h"
#include "core/text.h"

namespace raymoval::external_method {
namespace {

using nlohmann::json;

/// Names are used in folders, tables and `--set NAME.key=value`.
void check_name(const std::string& name, const std::string& where) {
  const bool legal = name_problem(name).empty() && name.size() <= 60 &&
                     std::all_of(name.begin(), name.end(), [](char c) {
                       return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                              (c >= 'a' && c <= 'z') || c == '-' || c == '_';
                     });
  if (!legal) {
    throw ConfigurationError(where + ": the name '" + name +
                             "' must be at most 60 letters, digits, '-' and '_', and not begin "
                             "with '-'.");
  }
}

ParameterValue default_of(const Fields& item) {
  const json& value = item.member("default");
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  item.fail("default", "true, false, a number or a text");
}

ParameterSpec parameter_of(const Fields& item, const std::string& method) {
  ParameterSpec spec;
  spec.name = item.text("name");
  check_name(spec.name, item.where());
  spec.default_value = default_of(item);
  spec.notes.unit = item.text("unit", "");
  spec.notes.minimum = item.number("minimum", spec.notes.minimum);
  spec.notes.maximum = item.number("maximum", spec.notes.maximum);
  spec.notes.source = item.text("source", "");
  spec.notes.sentence = item.text("sentence");
  spec.choices = item.texts("choices");
  if (!spec.choices.empty() && !std::holds_alternative<std::string>(spec.default_value)) {
    throw ConfigurationError(item.where() + ": 'choices' goes with a text as default.");
  }
  try {
    (void)checked_value(method, spec, item.member("default"));
  } catch (const ConfigurationError& error) {
    throw ConfigurationError(item.where() + ": " + error.what());
  }
  return spec;
}

std::vector<ParameterSpec> parameters_of(const Fields& file, const std::string& method) {
  std::vector<ParameterSpec> specs;
  for (const auto& [item, where] : file.list("parameters")) {
    ParameterSpec spec = parameter_of(
        Fields(*item, where, "name default unit minimum maximum choices source sentence"), method);
    for (const ParameterSpec& known : specs) {
      if (known.name != spec.name) continue;
      throw ConfigurationError(where + ": there are two parameters '" + spec.name + "'.");
    }
    specs.push_back(std::move(spec));
  }
  return specs;
}

/// A text; a whole number is also accepted as a text.
std::string version_of(const Fields& file) {
  if (!file.has("version") || !file.member("version").is_number_integer()) {
    return file.text("version");
  }
  return file.member("version").dump();
}

bool online_of(const Fields& file) {
  if (file.has("online")) return file.flag("online", false);
  throw ConfigurationError(file.where() + ": 'online' is missing: true if the answer for a scan " +
                           "comes from it and earlier scans only.");
}

std::filesystem::path absolute_file(const std::filesystem::path& path) {
  if (path.empty()) {
    throw ConfigurationError(
        "external: names no manifest. Expected external:PATH of a JSON file, such as "
        "external:method/manifest.json.");
  }
  std::error_code error;
  const auto found = std::filesystem::canonical(path, error);
  if (error) {
    throw ConfigurationError(path.string() + ": there is no such manifest (" + error.message() +
                             "). Expected external:PATH of a JSON file.");
  }
  return found;
}

/// The value of "{VARIABLE|default}".
/// @param inside "VARIABLE|default"
std::string from_environment(const std::string& inside, const std::string& where) {
  const std::size_t bar = inside.find('|');
  const std::string variable = inside.substr(0, bar);
  const bool legal = !variable.empty() && std::all_of(variable.begin(), variable.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
  if (bar == std::string::npos || !legal) {
    throw ConfigurationError(where + ": '{" + inside + "}' in 'command' is unknown. Supported " +
                             "are: {here}, {VARIABLE|default}.");
  }
  const char* value = std::getenv(variable.c_str());
  return value != nullptr && *value != '\0' ? value : inside.substr(bar + 1);
}

std::string argument_text(const std::string& written, const Manifest& manifest) {
  std::string text;
  std::size_t from = 0;
  for (std::size_t open; (open = written.find('{', from)) != std::string::npos;) {
    const std::size_t close = written.find('}', open);
    if (close == std::string::npos) break;
    const std::string inside = written.substr(open + 1, close - open - 1);
    text += written.substr(from, open - from);
    text += inside == "here" ? manifest.path.parent_path().string()
                             : from_environment(inside, manifest.path.string());
    from = close + 1;
  }
  return text + written.substr(from);
}

bool is_hidden(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with('.') || name == "__pycache__";
}

/// Links to folders are not followed, because they may form a cycle.
void add_files_below(const std::filesystem::path& folder, const std::filesystem::path& here,
                     std::vector<std::string>& found) {
  for (const std::filesystem::path& path : entries_of(folder)) {
    if (is_hidden(path)) continue;
    if (is_file(path)) {
      found.push_back(path.lexically_relative(here).generic_string());
    } else if (!std::filesystem::is_symlink(path)) {
      add_files_below(path, here, found);
    }
  }
}

/// `name` itself, or every file below it, as paths relative to the manifest's folder, sorted.
std::vector<std::string> files_below(const std::string& name, const Manifest& manifest) {
  namespace fs = std::filesystem;
  const fs::path here = manifest.path.parent_path();
  if (is_file(here / name)) return {name};
  if (!is_folder(here / name)) {
    throw DataError((here / name).string() + ": there is no such file, but " +
                    manifest.path.string() + " lists it as a file of the program.");
  }
  std::vector<std::string> found;
  add_files_below(here / name, here, found);
  std::sort(found.begin(), found.end());
  return found;
}

/// Files of the program, relative to the manifest's folder where they are below it.
std::vector<std::string> program_files(const Manifest& manifest) {
  std::vector<std::string> files;
  for (const std::string& name : manifest.files) {
    const auto below = files_below(name, manifest);
    files.insert(files.end(), below.begin(), below.end());
  }
  constexpr std::string_view kHere = "{here}/";
  for (const std::string& written : manifest.command) {
    const bool below = written.starts_with(kHere);
    const std::string path = below ? written.substr(kHere.size()) : written;
    if (path.find('{') != std::string::npos || (!below && !path.starts_with('/'))) continue;
    if (is_file(manifest.path.parent_path() / path)) files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace

Manifest read_manifest(const std::filesystem::path& path) {
  Manifest manifest;
  manifest.path = absolute_file(path);
  const json content = read_json(manifest.path);
  const Fields file(content, manifest.path.string(),
                    "name sentence source version online notes command files time_limit_s "
                    "disk_limit_gib parameters");
  manifest.name = file.text("name");
  check_name(manifest.name, file.where());
  manifest.sentence = file.text("sentence");
  manifest.source = file.text("source", "");
  manifest.version = version_of(file);
  manifest.online = online_of(file);
  manifest.notes = file.texts("notes");
  manifest.command = file.texts("command");
  if (manifest.command.empty() || manifest.command.front().empty()) {
    file.fail("command", "a list of a program and its arguments [ \"...\", ... ]");
  }
  manifest.files = file.texts("files");
  manifest.time_limit_s = file.positive("time_limit_s", manifest.time_limit_s);
  manifest.disk_limit_gib = file.positive("disk_limit_gib", manifest.disk_limit_gib);
  manifest.parameters = parameters_of(file, manifest.name);
  (void)command_line(manifest);
  return manifest;
}

std::vector<std::string> command_line(const Manifest& manifest) {
  std::vector<std::string> arguments;
  for (const std::string& written : manifest.command) {
    arguments.push_back(argument_text(written, manifest));
  }
  return arguments;
}

std::string program_hash(const Manifest& manifest) {
  ContentHasher hasher;
  const auto add = [&hasher](const std::string& text) {
    hasher.add(std::to_string(text.size()) + ":");  // so that different lists have different texts
    hasher.add(text);
  };
  add(read_text(manifest.path));
  for (const std::string& name : program_files(manifest)) {
    add(name);
    const auto bytes = read_bytes(manifest.path.parent_path() / name);
    add({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  return hasher.digest();
}

}  // namespace raymoval::external_method
