// SPDX-License-Identifier: MIT
#include "benchmark/result/controls_check.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/text.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

struct Expected {
  const char* control;
  const char* rate;
  double percent;
};

// The oracle keeps every static point, so all of them are found again (SA); how many static voxels
// (PR) or dynamic points near static ones (DA) it loses is up to the data.
constexpr Expected kExpected[] = {{"noop", "PR", 100.0},     {"noop", "RR", 0.0},
                                  {"noop", "SA", 100.0},     {"noop", "DA", 0.0},
                                  {"remove-all", "PR", 0.0}, {"remove-all", "RR", 100.0},
                                  {"remove-all", "SA", 0.0}, {"remove-all", "DA", 100.0},
                                  {"oracle", "RR", 100.0},   {"oracle", "SA", 100.0}};

/// Whether the protocol's options take away the oracle's certainty: labels found again by nearest
/// neighbour, or not looked at, let a static point stand in for a removed one.
bool oracle_is_uncertain(const ordered_json& options) {
  return options.value("label_mode", "") == "nearest" ||
         options.value("label_rule", "") == "geometry";
}

void check_protocol(const std::string& control, const std::string& sequence,
                    const ordered_json& protocol, std::vector<std::string>& problems) {
  if (control == "oracle" && oracle_is_uncertain(protocol["options"])) return;
  for (const Expected& expected : kExpected) {
    if (control != expected.control || !protocol["rates"].contains(expected.rate)) continue;
    const ordered_json& rate = protocol["rates"][expected.rate];
    if (rate.is_null() || std::abs(rate.get<double>() - expected.percent) < 1e-9) continue;
    problems.push_back("control '" + control + "' on " + sequence + ", protocol " +
                       protocol["name"].get<std::string>() + ": " + expected.rate + " is " +
                       number_text(rate.get<double>()) + ", must be " +
                       number_text(expected.percent));
  }
}

}  // namespace

std::vector<std::string> check_controls(const std::vector<ordered_json>& cells) {
  std::vector<std::string> problems;
  for (const ordered_json& cell : cells) {
    if (!cell["method"]["control"].get<bool>()) continue;
    const auto control = cell["method"]["name"].get<std::string>();
    const auto sequence = cell["sequence"].get<std::string>();
    if (cell["status"] != "ok") {
      problems.push_back("control '" + control + "' on " + sequence + " did not finish");
    }
    for (const ordered_json& protocol : cell["protocols"]) {
      check_protocol(control, sequence, protocol, problems);
    }
  }
  return problems;
}

}  // namespace raymoval
