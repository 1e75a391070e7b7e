// SPDX-License-Identifier: MIT
#include "methods/external/manifest.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"

namespace raymoval {
namespace {

using nlohmann::json;

[[noreturn]] void throw_wrong(const std::string& where, const std::string& key,
                              const std::string& expected) {
  throw ConfigurationError(where + ": '" + key + "' must be " + expected + ".");
}

std::string text_of(const json& object, const char* key, const std::string& where, bool needed) {
  if (!object.contains(key)) {
    if (!needed) return "";
    throw ConfigurationError(where + ": '" + key + "' is missing.");
  }
  if (!object[key].is_string()) throw_wrong(where, key, "a text");
  auto text = object[key].get<std::string>();
  if (needed && text.empty()) throw_wrong(where, key, "a text that is not empty");
  // An argument cannot hold it, and a name or sentence with it would end there.
  if (text.find('\0') != std::string::npos) throw_wrong(where, key, "a text without zero bytes");
  return text;
}

std::vector<std::string> texts_of(const json& object, const char* key, const std::string& where) {
  std::vector<std::string> texts;
  if (!object.contains(key)) return texts;
  const std::string expected = "a list of texts [ \"...\", ... ]";
  if (!object[key].is_array()) throw_wrong(where, key, expected);
  for (const json& item : object[key]) {
    if (!item.is_string() || item.get<std::string>().find('\0') != std::string::npos) {
      throw_wrong(where, key, expected);
    }
    texts.push_back(item.get<std::string>());
  }
  return texts;
}

double positive_of(const json& object, const char* key, const std::string& where, double usual) {
  if (!object.contains(key)) return usual;
  const json& value = object[key];
  if (!value.is_number() || !(value.get<double>() > 0.0) || !std::isfinite(value.get<double>())) {
    throw_wrong(where, key, "a number greater than 0");
  }
  return value.get<double>();
}

double bound_of(const json& object, const char* key, const std::string& where, double usual) {
  if (!object.contains(key)) return usual;
  if (!object[key].is_number()) throw_wrong(where, key, "a number");
  return object[key].get<double>();
}

/// Names stand in folders, tables and `--set NAME.key=value`.
void check_name(const std::string& name, const std::string& where) {
  const bool legal = name.size() <= 60 && std::all_of(name.begin(), name.end(), [](char c) {
                       return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                              (c >= 'a' && c <= 'z') || c == '-' || c == '_';
                     });
  if (!legal) {
    throw ConfigurationError(where + ": the name '" + name +
                             "' must be at most 60 letters, digits, '-' and '_'.");
  }
}

ParameterValue default_of(const json& item, const std::string& where) {
  if (!item.contains("default")) throw ConfigurationError(where + ": 'default' is missing.");
  const json& value = item["default"];
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  throw_wrong(where, "default", "true, false, a number or a text");
}

ParameterSpec parameter_of(const json& item, const std::string& method, const std::string& where) {
  check_keys(item,
             {"name", "default", "unit", "minimum", "maximum", "choices", "source", "sentence"},
             where);
  ParameterSpec spec;
  spec.name = text_of(item, "name", where, true);
  check_name(spec.name, where);
  spec.default_value = default_of(item, where);
  spec.notes.unit = text_of(item, "unit", where, false);
  spec.notes.minimum = bound_of(item, "minimum", where, spec.notes.minimum);
  spec.notes.maximum = bound_of(item, "maximum", where, spec.notes.maximum);
  spec.notes.source = text_of(item, "source", where, false);
  spec.notes.sentence = text_of(item, "sentence", where, true);
  spec.choices = texts_of(item, "choices", where);
  if (!spec.choices.empty() && !std::holds_alternative<std::string>(spec.default_value)) {
    throw ConfigurationError(where + ": 'choices' goes with a text as default.");
  }
  try {
    (void)checked_value(method, spec, item["default"]);
  } catch (const ConfigurationError& error) {
    throw ConfigurationError(where + ": " + error.what());
  }
  return spec;
}

void read_parameters(const json& file, const std::string& where, Manifest& manifest) {
  if (!file.contains("parameters")) return;
  const json& list = file["parameters"];
  if (!list.is_array()) throw_wrong(where, "parameters", "a list of objects [ { ... }, ... ]");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = where + ": parameters[" + std::to_string(i) + "]";
    ParameterSpec spec = parameter_of(list[i], manifest.name, place);
    for (const ParameterSpec& known : manifest.parameters) {
      if (known.name == spec.name) {
        throw ConfigurationError(place + ": there are two parameters '" + spec.name + "'.");
      }
    }
    manifest.parameters.push_back(std::move(spec));
  }
}

bool online_of(const json& file, const std::string& where) {
  if (!file.contains("online")) {
    throw ConfigurationError(where + ": 'online' is missing: true if the answer for a scan comes " +
                             "from it and earlier scans only.");
  }
  if (!file["online"].is_boolean()) throw_wrong(where, "online", "true or false");
  return file["online"].get<bool>();
}

std::filesystem::path absolute_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto found = std::filesystem::canonical(path, error);
  if (error) {
    throw ConfigurationError(path.string() + ": there is no such manifest (" + error.message() +
                             "). Expected external:PATH of a JSON file.");
  }
  return found;
}

/// "VARIABLE|default" without the braces; nothing that could be a variable leaves the text as it
/// is.
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

/// Links to folders are not followed: they may lead in a circle.
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
                    manifest.path.string() + " says that it belongs to the program.");
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
  const json file = read_json(manifest.path);
  const std::string where = manifest.path.string();
  check_keys(file,
             {"name", "sentence", "source", "version", "online", "notes", "command", "files",
              "time_limit_s", "disk_limit_gib", "parameters"},
             where);
  manifest.name = text_of(file, "name", where, true);
  check_name(manifest.name, where);
  manifest.sentence = text_of(file, "sentence", where, true);
  manifest.source = text_of(file, "source", where, false);
  manifest.version = text_of(file, "version", where, true);
  manifest.online = online_of(file, where);
  manifest.notes = texts_of(file, "notes", where);
  manifest.command = texts_of(file, "command", where);
  if (manifest.command.empty() || manifest.command.front().empty()) {
    throw_wrong(where, "command", "a list of a program and its arguments [ \"...\", ... ]");
  }
  manifest.files = texts_of(file, "files", where);
  manifest.time_limit_s = positive_of(file, "time_limit_s", where, manifest.time_limit_s);
  manifest.disk_limit_gib = positive_of(file, "disk_limit_gib", where, manifest.disk_limit_gib);
  read_parameters(file, where, manifest);
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
    hasher.add(std::to_string(text.size()) + ":");  // so that no two lists read the same
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

}  // namespace raymoval
