// SPDX-License-Identifier: MIT
#include "datasets/simulation/scene/scene_text.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/frames.h"

namespace raymoval {
namespace {

using Setter = std::function<void(SimulationOptions&, const std::string& what, const std::string&)>;

std::pair<std::string, Setter> angle_setter(const char* key, double SimulationOptions::*angle) {
  return {key, [angle](auto& options, auto& what, auto& text) {
            options.*angle = parse_turn(what, text);
          }};
}

const std::vector<std::pair<std::string, Setter>>& setters() {
  static const std::vector<std::pair<std::string, Setter>> all = {
      {"scans",
       [](auto& options, auto& what, auto& text) { options.scans = parse_scan_count(what, text); }},
      {"seed",
       [](auto& options, auto& what, auto& text) { options.seed = parse_seed(what, text); }},
      {"sensor", [](auto& options, auto&, auto& text) { options.sensor = text; }},
      {"pose_noise", [](auto& options, auto& what,
                        auto& text) { options.pose_noise = parse_pose_noise(what, text); }},
      {"rolling",
       [](auto& options, auto& what, auto& text) { options.rolling = parse_rolling(what, text); }},
      angle_setter("turned", &SimulationOptions::turned_deg),
      angle_setter("tilted", &SimulationOptions::tilted_deg),
      angle_setter("roll", &SimulationOptions::roll_deg),
      angle_setter("pitch", &SimulationOptions::pitch_deg),
      angle_setter("yaw", &SimulationOptions::yaw_deg)};
  return all;
}

const Setter& setter_of(const std::string& key, const std::string& text) {
  std::vector<std::string> names;
  for (const auto& [name, set] : setters()) {
    if (name == key) return set;
    names.push_back(name);
  }
  throw UsageError(text + ": a scene has no option '" + key + "'." + suggestion(key, names) +
                   " Expected " + kSceneForm + ".");
}

/// Scene and options of `text`. A path may contain colons, so it ends behind ".json".
std::pair<std::string, std::string> parts_of(const std::string& text) {
  const std::size_t ending = text.find(".json:");
  if (ending == std::string::npos && text.ends_with(".json") && is_file(text)) return {text, ""};
  const std::size_t colon = ending == std::string::npos ? text.find(':') : ending + 5;
  if (colon == std::string::npos) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

}  // namespace

bool names_scene(const std::string& text) {
  const std::string scene = parts_of(text).first;
  if (scene.ends_with(".json")) return is_file(scene);
  const std::vector<std::string> names = simulated_scene_names();
  return std::find(names.begin(), names.end(), scene) != names.end();
}

SimulationOptions parse_scene(const std::string& text) {
  const auto [scene, rest] = parts_of(text);
  SimulationOptions options;
  options.scene = scene;
  if (scene.size() == text.size()) return options;
  std::vector<std::string> given;
  for (const std::string_view part : split(rest, ',')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos || equals + 1 == part.size()) {
      throw UsageError(text + ": '" + std::string(part) + "' is not key=value. Expected " +
                       kSceneForm + "; write ./" + scene + " for a folder of that name.");
    }
    const std::string key(part.substr(0, equals));
    setter_of(key, text)(options, text + ": " + key, std::string(part.substr(equals + 1)));
    if (std::find(given.begin(), given.end(), key) != given.end()) {
      throw UsageError(text + ": gives " + key + " twice; leave one out.");
    }
    given.push_back(key);
  }
  return options;
}

std::size_t parse_scan_count(const std::string& what, const std::string& text) {
  const auto value = parse_number<std::size_t>(text);
  if (value && *value >= 1 && *value <= 1'000'000) return *value;
  throw UsageError(what + " " + text + ": expected a whole number from 1 to 1,000,000.");
}

std::uint64_t parse_seed(const std::string& what, const std::string& text) {
  const auto value = parse_number<std::uint64_t>(text);
  if (value) return *value;
  throw UsageError(what + " " + text + ": expected a whole number from 0 on.");
}

double parse_pose_noise(const std::string& what, const std::string& text) {
  const auto value = parse_number<double>(text);
  if (value && *value >= 0.0 && *value <= 100.0) return *value;
  throw UsageError(what + " " + text +
                   ": expected a number from 0 (perfect poses) to 100; 1 is a good odometry.");
}

double parse_turn(const std::string& what, const std::string& text) {
  const auto value = parse_number<double>(text);
  if (value && *value >= -360.0 && *value <= 360.0) return *value;
  throw UsageError(what + " " + text + ": expected degrees from -360 to 360.");
}

Rolling parse_rolling(const std::string& what, const std::string& text) {
  const std::vector<std::string> names(std::begin(kRollingNames), std::end(kRollingNames));
  const auto found = std::find(names.begin(), names.end(), text);
  if (found != names.end()) return static_cast<Rolling>(found - names.begin());
  throw UsageError(what + " " + text + ": is unknown." + suggestion(text, names));
}

}  // namespace raymoval
