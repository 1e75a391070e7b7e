// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace raymoval {

/// What a label word means for an evaluation.
enum class LabelClass : std::uint8_t { kStatic = 0, kMoving = 1, kIgnored = 2 };

/// Names of semantic ids, such as 252: "moving-car".
using ClassNames = std::map<std::uint16_t, std::string>;
/// The names of SemanticKITTI's ids.
const ClassNames& semantickitti_class_names();

/// Which semantic ids move and which are ignored; every other id is static.
struct LabelRule {
  std::string name = "semantickitti";
  std::vector<std::uint16_t> moving = {252, 253, 254, 255, 256, 257, 258, 259};
  std::vector<std::uint16_t> ignored = {};
  ClassNames class_names = semantickitti_class_names();

  /// The name of `id`; "label-7" for an id without a name.
  [[nodiscard]] std::string class_name(std::uint16_t id) const;
  [[nodiscard]] LabelClass classify(std::uint32_t word) const;
};

/// The name of a rule that needs no file: an object moves only in the scans in which it is in
/// motion. Only some data has this information.
inline constexpr const char* kMovingNow = "moving-now";
/// Whether `rule` names a file.
inline bool is_rule_file(const std::string& rule) {
  return rule != kMovingNow;
}

/// Reads {"moving": [ids], "ignored": [ids], "name": text}; missing keys keep `base`'s values.
/// @throws ConfigurationError if an id is no whole number from 0 to 65535 or is in both lists.
LabelRule label_rule_from_json(const nlohmann::json& json, const LabelRule& base,
                               const std::string& where);
nlohmann::ordered_json to_json(const LabelRule& rule);

}  // namespace raymoval
