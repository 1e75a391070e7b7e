// SPDX-License-Identifier: MIT
#include "datasets/layout.h"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/semantickitti/semantickitti.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

bool is_sensor_folder(const fs::path& folder) {
  return has_folder(folder / "velodyne");
}

/// A root has the lists of its parts.
bool is_root(const fs::path& folder) {
  const auto is_listed = [&](const char* part) { return has_file(folder / part); };
  return is_folder(folder) && is_listed("train.txt") && is_listed("val.txt") &&
         is_listed("test.txt");
}

std::vector<std::string> sensors_in(const fs::path& root) {
  std::vector<std::string> names;
  for (const fs::path& folder : folders_in(root)) {
    if (is_sensor_folder(folder)) names.push_back(folder.filename().string());
  }
  return names;
}

bool is_sensor_of_root(const std::string& path) {
  return is_folder(path) && is_sensor_folder(path) && is_root(fs::path(path) / "..");
}

/// ROOT and Ouster of "ROOT:Ouster"; the second is empty if there is no such part.
std::pair<std::string, std::string> parts_of(const std::string& path) {
  const std::size_t colon = is_there(path) ? std::string::npos : path.rfind(':');
  if (colon == std::string::npos) return {path, ""};
  return {path.substr(0, colon), path.substr(colon + 1)};
}

bool names_helimos(const std::string& path) {
  if (is_sensor_of_root(path)) return true;
  const std::string root = parts_of(path).first;
  return is_there(root) && is_root(root) && !sensors_in(root).empty();
}

fs::path folder_of_sensor(const std::string& path) {
  const auto [root, sensor] = parts_of(path);
  return sensor.empty() ? fs::path(root) : fs::path(root) / sensor;
}

/// The sensor's folder. @throws UsageError if `path` names none
fs::path named_sensor(const std::string& path) {
  if (is_sensor_of_root(path)) return path;
  const auto [root, sensor] = parts_of(path);
  const std::vector<std::string> there = sensors_in(root);
  if (std::find(there.begin(), there.end(), sensor) != there.end()) return fs::path(root) / sensor;
  throw UsageError(root + ": is a root with a folder for each sensor" +
                   (sensor.empty() ? "" : ", and has none for '" + sensor + "'") + ". It has " +
                   join(there) + "; name one, such as " + root + ":" + there.front() + ".");
}

Sequence open_helimos(Layout::Path path, const SequenceOptions& options,
                      const OpenContext& context) {
  SemanticKittiDefaults defaults;
  defaults.label_rule.name = "helimos";
  defaults.label_rule.moving = {251, 252, 253, 254, 255, 256, 257, 258, 259};
  defaults.label_rule.ignored = {0};
  Sequence sequence = open_semantickitti(named_sensor(path), options, context, defaults);
  const Layout layout = helimos_layout();
  sequence.layout = layout.name;
  sequence.label_rule.class_names = layout.class_names;
  return sequence;
}

}  // namespace

Layout helimos_layout() {
  Layout layout = semantickitti_layout();
  layout.name = "helimos";
  layout.expected = "a HeLiMOS root as ROOT:Ouster (Ouster/velodyne, train.txt, val.txt, test.txt)";
  layout.forms = {{"ROOT:Ouster", "a sensor of a HeLiMOS root folder, or that sensor's folder"}};
  // The classes of SemanticKITTI, and two of HeLiMOS.
  layout.class_names[9] = "static";
  layout.class_names[251] = "moving";
  layout.recognise = names_helimos;
  layout.open = open_helimos;
  layout.folder_of = folder_of_sensor;
  return layout;
}

}  // namespace raymoval
