// SPDX-License-Identifier: MIT
#include "eval/erasor/erasor.h"

#include "eval/erasor/options.h"
#include "eval/erasor/rates.h"
#include "eval/erasor/scorer.h"

namespace raymoval {
namespace {

std::unique_ptr<Scorer> open_erasor(const EvaluationInput& input, const Configuration& options) {
  return erasor::make_scorer(input, erasor::option_table().read(options));
}

bool frame_needs_calibration(const Configuration& options) {
  return erasor::option_table().read(options).frame == erasor::FrameOption::kErasor;
}

/// Labels that are found again by nearest neighbour, or not looked at, let a static point stand in
/// for a removed one.
bool labels_are_uncertain(const Configuration& configuration) {
  const erasor::Options options = erasor::option_table().read(configuration);
  return options.label_mode == erasor::LabelMode::kNearest ||
         options.label_rule == erasor::LabelRuleOption::kGeometry;
}

}  // namespace

ProtocolEntry erasor_protocol_entry() {
  return {.name = "erasor",
          .version = "1",
          .sentence =
              "Preservation and rejection rate over labelled map voxels (ERASOR paper): "
              "PR, RR, F1.",
          .parameters = erasor::option_table().specs(),
          .rates = erasor::rate_list(),
          .counts = erasor::count_list(),
          .open = open_erasor,
          .cloud_options = {{"label_mode", std::string("nearest")}, {"lift", 0.0}},
          .reads_calibration = frame_needs_calibration,
          .oracle_is_uncertain = labels_are_uncertain};
}

}  // namespace raymoval
