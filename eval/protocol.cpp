// SPDX-License-Identifier: MIT
#include "eval/protocol.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "eval/scan_passes.h"

namespace raymoval {
namespace {

/// "frame = erasor": the options that are not at their defaults.
std::string changed_options(const ProtocolEntry& entry, const Configuration& options) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (options[i].second == entry.parameters[i].default_value) continue;
    texts.push_back(options[i].first + " = " + parameter_text(options[i].second));
  }
  return join(texts);
}

}  // namespace

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

ProtocolResult Scorer::score(const MaskStore& masks) const {
  const std::unique_ptr<Scoring> scoring = start();
  run_passes(input_, masks, {scoring.get()});
  return scoring->result();
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

Configuration default_options(const ProtocolEntry& entry) {
  Configuration options;
  for (const ParameterSpec& spec : entry.parameters) {
    options.emplace_back(spec.name, spec.default_value);
  }
  return options;
}

Protocol::Protocol(const ProtocolEntry& entry, const Configuration& options)
    : entry_(entry), options_(default_options(entry)) {
  for (const auto& [key, value] : options) {
    find_parameter("protocol " + entry.name, entry.parameters, key);
    set_parameter(options_, key, value);
  }
}

bool Protocol::reads_calibration() const {
  return entry_.reads_calibration && entry_.reads_calibration(options_);
}

void Protocol::check(const EvaluationInput& input) const {
  check_input(input, name());
  if (!reads_calibration() || input.T_camera_lidar) return;
  throw DataError(fmt::format(
      "protocol {} as asked for ({}) needs the calibration of a camera (calib.txt, row Tr) and its "
      "poses; this sequence has those of the LiDAR. Leave the options at their defaults.",
      name(), changed_options(entry_, options_)));
}

std::unique_ptr<Scorer> Protocol::open(const EvaluationInput& input) const {
  check(input);
  return entry_.open(input, options_);
}

}  // namespace raymoval
