// SPDX-License-Identifier: MIT
#include "eval/erasor/erasor.h"

#include "core/error.h"
#include "eval/erasor/options.h"
#include "eval/erasor/rates.h"
#include "eval/erasor/scorer.h"

namespace raymoval {
namespace {

using namespace erasor;

class ErasorProtocol : public Protocol {
 public:
  explicit ErasorProtocol(const Options& options) : options_(options) {}
  [[nodiscard]] std::string name() const override { return "erasor"; }
  [[nodiscard]] std::string version() const override { return "1"; }
  [[nodiscard]] Configuration options() const override { return option_table().write(options_); }
  [[nodiscard]] bool reads_calibration() const override {
    return options_.frame == FrameOption::kErasor;
  }

  void check(const EvaluationInput& input) const override {
    Protocol::check(input);
    if (!reads_calibration() || input.T_camera_lidar) return;
    throw DataError(
        "protocol erasor with frame = erasor needs the calibration of a camera (calib.txt, row Tr) "
        "and its poses; this sequence has those of the LiDAR. Leave the option at frame = "
        "sequence.");
  }

  [[nodiscard]] std::unique_ptr<Scorer> open(const EvaluationInput& input) const override {
    check(input);
    return make_scorer(input, options_);
  }

 private:
  Options options_;
};

/// Labels that are found again by nearest neighbour, or not looked at, let a static point stand in
/// for a removed one.
bool oracle_is_uncertain(const Configuration& configuration) {
  const Options options = option_table().read(configuration);
  return options.label_mode == LabelMode::kNearest ||
         options.label_rule == LabelRuleOption::kGeometry;
}

}  // namespace

ProtocolEntry erasor_protocol_entry() {
  return {
      .name = "erasor",
      .sentence =
          "Preservation and rejection rate over labelled map voxels (ERASOR paper): PR, RR, F1.",
      .parameters = option_table().specs(),
      .rates = rate_list(),
      .counts = count_list(),
      .make = [](const Configuration& options) -> std::unique_ptr<Protocol> {
        return std::make_unique<ErasorProtocol>(option_table().read(options));
      },
      .cloud_options = {{"label_mode", std::string("nearest")}, {"lift", 0.0}},
      .oracle_is_uncertain = oracle_is_uncertain};
}

}  // namespace raymoval
