// SPDX-License-Identifier: MIT
#include "datasets/simulation/scene/library.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/strict_json.h"
#include "core/text.h"
#include "datasets/simulation/scene/simulated.h"

namespace raymoval::simulated {
namespace {

std::vector<std::string> names_of(const std::vector<BuiltInFile>& files) {
  std::vector<std::string> names;
  for (const BuiltInFile& file : files) names.emplace_back(file.name);
  return names;
}

NamedText find(const std::vector<BuiltInFile>& files, const std::string& what,
               const std::string& name) {
  if (name.ends_with(".json")) {
    const std::filesystem::path path(name);
    return {path.stem().string(), read_text(path), name};
  }
  for (const BuiltInFile& file : files) {
    if (file.name == name) return {name, std::string(file.text), name + ".json"};
  }
  throw UsageError("there is no simulated " + what + " '" + name + "'." +
                   suggestion(name, names_of(files)) + " A path to a file must end in .json.");
}

}  // namespace

NamedText find_world(const std::string& name) {
  return find(built_in_worlds(), "scene", name);
}
NamedText find_sensor(const std::string& name) {
  return find(built_in_sensors(), "sensor", name);
}

WorldFile parse_world(const NamedText& file) {
  return world_from_json(parse_json(file.text, file.file), file.file);
}

SensorFile parse_sensor(const NamedText& file) {
  return sensor_from_json(parse_json(file.text, file.file), file.file);
}

}  // namespace raymoval::simulated

namespace raymoval {

std::vector<std::string> simulated_scene_names() {
  return simulated::names_of(simulated::built_in_worlds());
}
std::vector<std::string> simulated_sensor_names() {
  return simulated::names_of(simulated::built_in_sensors());
}
std::string simulated_scene_text(const std::string& name) {
  return simulated::find_world(name).text;
}
std::string simulated_sensor_text(const std::string& name) {
  return simulated::find_sensor(name).text;
}

}  // namespace raymoval
