// SPDX-License-Identifier: MIT
#include "eval/protocol.h"

#include "core/error.h"

namespace raymoval {

std::int64_t ProtocolResult::count(const std::string& name) const {
  for (const auto& [key, value] : counts) {
    if (key == name) return value;
  }
  throw InternalError("protocol '" + protocol + "' has no count '" + name + "'");
}

std::optional<double> ProtocolResult::rate(const std::string& name) const {
  for (const Rate& rate : rates) {
    if (rate.name == name) return rate.value;
  }
  return std::nullopt;
}

ProtocolResult Scorer::score_cloud(const CloudEstimate& /*cloud*/) const {
  throw UsageError("this protocol scores no clouds: expected masks.");
}

void check_input(const EvaluationInput& input, const std::string& asker) {
  if (input.scans == nullptr) throw InternalError("protocol " + asker + " was given no scans");
  if (input.labels != nullptr) return;
  throw DataError("protocol " + asker +
                  " needs a label for each point and the sequence has none: expected label files. "
                  "Choose labelled data.");
}

}  // namespace raymoval
