// SPDX-License-Identifier: MIT
#include "core/scan/label_rule.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "core/scan/scan_source.h"

namespace raymoval {
namespace {

bool contains(const std::vector<std::uint16_t>& ids, std::uint16_t id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

std::vector<std::uint16_t> read_ids(const nlohmann::json& json, const std::string& where) {
  if (!json.is_array()) throw ConfigurationError(where + ": expected a list of label ids.");
  std::vector<std::uint16_t> ids;
  for (const auto& item : json) {
    if (!item.is_number_integer() || item.get<std::int64_t>() < 0 ||
        item.get<std::int64_t>() > 0xFFFF) {
      throw ConfigurationError(where + ": " + item.dump() +
                               " is not a label id: expected whole numbers from 0 to 65535.");
    }
    ids.push_back(item.get<std::uint16_t>());
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

}  // namespace

const ClassNames& semantickitti_class_names() {
  // From the data set's own list (semantic-kitti.yaml).
  static const ClassNames names = {{0, "unlabelled"},
                                   {1, "outlier"},
                                   {10, "car"},
                                   {11, "bicycle"},
                                   {13, "bus"},
                                   {15, "motorcycle"},
                                   {16, "on-rails"},
                                   {18, "truck"},
                                   {20, "other-vehicle"},
                                   {30, "person"},
                                   {31, "bicyclist"},
                                   {32, "motorcyclist"},
                                   {40, "road"},
                                   {44, "parking"},
                                   {48, "sidewalk"},
                                   {49, "other-ground"},
                                   {50, "building"},
                                   {51, "fence"},
                                   {52, "other-structure"},
                                   {60, "lane-marking"},
                                   {70, "vegetation"},
                                   {71, "trunk"},
                                   {72, "terrain"},
                                   {80, "pole"},
                                   {81, "traffic-sign"},
                                   {99, "other-object"},
                                   {252, "moving-car"},
                                   {253, "moving-bicyclist"},
                                   {254, "moving-person"},
                                   {255, "moving-motorcyclist"},
                                   {256, "moving-on-rails"},
                                   {257, "moving-bus"},
                                   {258, "moving-truck"},
                                   {259, "moving-other-vehicle"}};
  return names;
}

std::string LabelRule::class_name(std::uint16_t id) const {
  const auto found = class_names.find(id);
  return found != class_names.end() ? found->second : "label-" + std::to_string(id);
}

LabelClass LabelRule::classify(std::uint32_t word) const {
  const std::uint16_t id = semantic_id(word);
  if (contains(moving, id)) return LabelClass::kMoving;
  return contains(ignored, id) ? LabelClass::kIgnored : LabelClass::kStatic;
}

LabelRule label_rule_from_json(const nlohmann::json& json, const LabelRule& base,
                               const std::string& where) {
  check_keys(json, {"name", "moving", "ignored"}, where);
  LabelRule rule = base;
  if (json.contains("name")) {
    if (!json["name"].is_string()) throw ConfigurationError(where + ".name: expected a text.");
    rule.name = json["name"].get<std::string>();
  }
  if (json.contains("moving")) rule.moving = read_ids(json["moving"], where + ".moving");
  if (json.contains("ignored")) rule.ignored = read_ids(json["ignored"], where + ".ignored");
  for (const std::uint16_t id : rule.moving) {
    if (contains(rule.ignored, id)) {
      throw ConfigurationError(where + ": label id " + std::to_string(id) +
                               " is both moving and ignored; leave it in one list.");
    }
  }
  return rule;
}

nlohmann::ordered_json to_json(const LabelRule& rule) {
  return {{"name", rule.name}, {"moving", rule.moving}, {"ignored", rule.ignored}};
}

}  // namespace raymoval
