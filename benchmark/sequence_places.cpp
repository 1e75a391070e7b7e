// SPDX-License-Identifier: MIT
#include "benchmark/sequence_places.h"

#include <nlohmann/json.hpp>

#include "benchmark/sealed_json.h"
#include "core/error.h"
#include "core/text.h"
#include "datasets/simulated/scene_text.h"

namespace raymoval {

using nlohmann::ordered_json;

namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "sources.json";

std::string absolute_text(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  return error ? path.string() : absolute.lexically_normal().string();
}

/// The path as it reads from any folder. "ROOT:05" and "SCENE.json:seed=3" are paths up to a colon;
/// names of built-in scenes stay.
std::string located(const std::string& path) {
  std::error_code ignored;
  if (path == "street" || (path.find('/') == std::string::npos && names_scene(path))) return path;
  if (fs::exists(path, ignored)) return absolute_text(path);
  for (std::size_t colon = path.find(':'); colon != std::string::npos;
       colon = path.find(':', colon + 1)) {
    const std::string start = path.substr(0, colon);
    if (fs::exists(start, ignored)) return absolute_text(start) + path.substr(colon);
  }
  return path;
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
    if (key == "name") options.name = text;
    if (!key.starts_with("range_")) continue;
    if (!options.range_m) options.range_m.emplace();
    const double metres = parse_number<double>(text).value();
    (key == "range_min" ? options.range_m->min : options.range_m->max) = metres;
  }
  return place;
}

void write_sources(const fs::path& run, const std::vector<SequenceRequest>& places,
                   const std::vector<Sequence>& sequences) {
  ordered_json record;
  record["sequences"] = ordered_json::object();
  for (std::size_t i = 0; i < places.size(); ++i) {
    SequenceRequest place = places[i];
    place.path = located(place.path);
    if (place.options.label_rule) {
      place.options.label_rule = absolute_text(*place.options.label_rule);
    }
    record["sequences"][sequences[i].name] = place_record(place);
  }
  write_sealed(run / kFile, std::move(record));
}

std::map<std::string, SequenceRequest> read_sources(const fs::path& run) {
  std::map<std::string, SequenceRequest> places;
  const fs::path file = run / kFile;
  if (!fs::exists(file)) return places;
  const ordered_json record = read_sealed(file);
  try {
    for (const auto& [name, place] : record.at("sequences").items()) {
      places[name] = place_from(place);
    }
  } catch (const ordered_json::exception& error) {
    throw DataError(file.string() + ": does not say where sequences are (" + error.what() +
                    "). Start `raymoval run` again with the same --out.");
  }
  return places;
}

}  // namespace raymoval
