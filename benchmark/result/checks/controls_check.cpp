// SPDX-License-Identifier: MIT
#include "benchmark/result/checks/controls_check.h"

#include <fmt/format.h>

#include <cmath>

#include "benchmark/suite/suite.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

void check_score(const Cell& cell, KnownAnswer answer, const Score& score,
                 std::vector<std::string>& problems) {
  const ProtocolEntry* protocol = find_protocol(score.protocol.protocol);
  if (protocol == nullptr) return;
  const bool uncertain =
      protocol->oracle_is_uncertain && protocol->oracle_is_uncertain(score.protocol.options);
  if (answer == KnownAnswer::kMovingPointsRemoved && uncertain) return;
  for (const RateSpec& spec : protocol->rates) {
    const auto rate = score.rate(spec.name), expected = spec.expected(answer);
    if (!rate || !expected || std::abs(*rate - *expected) < 1e-9) continue;
    problems.push_back(fmt::format("control '{}' on {}, protocol {}: {} is {}, must be {}",
                                   cell.method.name, cell.sequence, score.protocol.name, spec.name,
                                   number_text(*rate), number_text(*expected)));
  }
}

}  // namespace

std::vector<std::string> check_controls(const std::vector<Cell>& cells) {
  std::vector<std::string> problems;
  for (const Cell& cell : cells) {
    const std::optional<KnownAnswer> answer = known_answer(cell.method.name);
    if (!answer) continue;
    if (!cell.ok()) {
      problems.push_back("control '" + cell.method.name + "' on " + cell.sequence +
                         " did not finish");
    }
    for (const Score& score : cell.scores) check_score(cell, *answer, score, problems);
  }
  return problems;
}

}  // namespace raymoval
