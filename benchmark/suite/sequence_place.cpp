// SPDX-License-Identifier: MIT
#include "benchmark/suite/sequence_place.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/open_sequence.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

/// "town" of "town:scans=60": a scene that the program brings along.
bool is_built_in(const std::string& path) {
  const std::string name = path.substr(0, path.find(':'));
  const std::vector<std::string> scenes = scene_names();
  return std::find(scenes.begin(), scenes.end(), name) != scenes.end();
}

}  // namespace

ordered_json place_record(const SequenceRequest& place) {
  ordered_json record;
  record["path"] = place.path;
  const SequenceOptions& options = place.options;
  if (options.frames) record["frames"] = frame_range_text(*options.frames);
  if (options.poses) record["poses"] = *options.poses;
  if (options.label_rule) record["label_rule"] = options.label_rule->string();
  if (options.sensor) record["sensor"] = *options.sensor;
  if (options.up) record["up"] = *options.up;
  if (options.drop_ego) record["drop_ego"] = ego_region_text(*options.drop_ego);
  if (options.name) record["name"] = *options.name;
  if (options.range_m) {
    record["range_min"] = number_text(options.range_m->min);  // As text: the limit may be infinite.
    record["range_max"] = number_text(options.range_m->max);
  }
  return record;
}

SequenceRequest place_from(const ordered_json& record) {
  SequenceRequest place;
  place.path = record.at("path").get<std::string>();
  SequenceOptions& options = place.options;
  for (const auto& [key, value] : record.items()) {
    const auto text = value.get<std::string>();
    if (key == "frames") options.frames = parse_frame_range(text);
    if (key == "poses") options.poses = text;
    if (key == "label_rule") options.label_rule = text;
    if (key == "sensor") options.sensor = text;
    if (key == "up") options.up = text;
    if (key == "drop_ego") options.drop_ego = parse_ego_region(text);
    if (key == "name") options.name = text;
    if (!key.starts_with("range_")) continue;
    if (!options.range_m) options.range_m.emplace();
    const double metres = parse_number<double>(text).value();
    (key == "range_min" ? options.range_m->min : options.range_m->max) = metres;
  }
  return place;
}

SequenceRequest absolute_place(const SequenceRequest& place) {
  SequenceRequest absolute = place;
  const auto make_absolute = [&](const std::filesystem::path& path) {
    std::error_code error;
    const auto made = std::filesystem::absolute(path, error);
    return error ? path : made.lexically_normal();
  };
  if (!is_built_in(place.path)) absolute.path = make_absolute(place.path).string();
  SequenceOptions& options = absolute.options;
  // A pose file may also be a name in the sequence folder.
  if (options.poses && has_file(*options.poses)) {
    options.poses = make_absolute(*options.poses).string();
  }
  if (options.label_rule) options.label_rule = make_absolute(*options.label_rule);
  return absolute;
}

}  // namespace raymoval
