// SPDX-License-Identifier: MIT
#include "benchmark/result/controls_check.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"

namespace raymoval {
namespace {

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
bool oracle_is_uncertain(const ProtocolRecord& protocol) {
  const auto is = [&](const char* option, const char* value) {
    return std::find(protocol.options.begin(), protocol.options.end(),
                     std::pair<std::string, ParameterValue>(option, std::string(value))) !=
           protocol.options.end();
  };
  return is("label_mode", "nearest") || is("label_rule", "geometry");
}

void check_score(const Cell& cell, const Score& score, std::vector<std::string>& problems) {
  const std::string& control = cell.method.name;
  if (control == "oracle" && oracle_is_uncertain(score.protocol)) return;
  for (const Expected& expected : kExpected) {
    if (control != expected.control) continue;
    const std::optional<double> rate = score.rate(expected.rate);
    if (!rate || std::abs(*rate - expected.percent) < 1e-9) continue;
    problems.push_back("control '" + control + "' on " + cell.sequence + ", protocol " +
                       score.protocol.name + ": " + expected.rate + " is " + number_text(*rate) +
                       ", must be " + number_text(expected.percent));
  }
}

}  // namespace

std::vector<std::string> check_controls(const std::vector<Cell>& cells) {
  std::vector<std::string> problems;
  for (const Cell& cell : cells) {
    if (!cell.method.control) continue;
    if (!cell.ok()) {
      problems.push_back("control '" + cell.method.name + "' on " + cell.sequence +
                         " did not finish");
    }
    for (const Score& score : cell.scores) check_score(cell, score, problems);
  }
  return problems;
}

}  // namespace raymoval
