// SPDX-License-Identifier: MIT
#include "core/scan/label_rule.h"

#include <nlohmann/json.hpp>

#include "core/files/files.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_label_rule(std::string_view bytes) {
  fuzz::may_refuse([&] {
    const nlohmann::json json = read_json(fuzz::input_file("rule.json", bytes));
    const LabelRule rule = label_rule_from_json(json, {}, "rule.json");
    for (const std::uint16_t id : rule.moving) {
      fuzz::require(rule.classify(id) == LabelClass::kMoving, "a moving label does not move");
    }
    for (const std::uint16_t id : rule.ignored) {
      fuzz::require(rule.classify(id) == LabelClass::kIgnored, "an ignored label is not ignored");
    }
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(label_rule, try_label_rule)
