// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "eval/points/checked_scan.h"
#include "eval/points/labelled_voxels.h"
#include "eval/protocol_registry.h"

namespace raymoval::test {

/// Counts points by index. All of its rates are fractions of mistakes, so lower is better.
class ToyScorer : public Scorer {
 public:
  explicit ToyScorer(const EvaluationInput& input) : input_(input) {}

  [[nodiscard]] ProtocolResult score(const MaskStore& masks) const override {
    check_mask_count(input_, masks);
    const LabelClasses classes(input_.label_rule);
    std::int64_t moving = 0, still = 0, left = 0, lost = 0;
    for (std::size_t i = 0; i < input_.scans->size(); ++i) {
      const CheckedScan loaded = load_checked(input_, &masks, i);
      for (std::size_t p = 0; p < loaded.labels.size(); ++p) {
        const bool moves = classes.moving(loaded.labels[p]);
        ++(moves ? moving : still);
        if (moves != loaded.removed(p)) ++(moves ? left : lost);
      }
    }
    ProtocolResult result;
    result.protocol = "toy";
    result.counts = {
        {"toy_moving", moving}, {"toy_static", still}, {"toy_left", left}, {"toy_lost", lost}};
    const auto add = [&](const char* name, std::int64_t part, std::int64_t whole) {
      Rate rate = percent_rate(name, part, whole, "there is no such point");
      if (rate.value) *rate.value /= 100.0;
      result.rates.push_back(rate);
    };
    add("lost", lost, still);
    add("left", left, moving);
    add("mistakes", left + lost, moving + still);
    add("lost_of_all", lost, moving + still);
    return result;
  }

 private:
  EvaluationInput input_;
};

inline ProtocolEntry toy_protocol_entry() {
  return {
      .name = "toy",
      .version = "1",
      .sentence = "Mistakes over points.",
      .parameters = {},
      .rates = {{.name = "lost",
                 .unit = RateUnit::kFraction,
                 .decimals = 5,
                 .higher_is_better = false,
                 .role = RateRole::kKept,
                 .nothing_removed = 0.0,
                 .everything_removed = 1.0,
                 .moving_points_removed = 0.0},
                {.name = "left",
                 .unit = RateUnit::kFraction,
                 .decimals = 3,
                 .higher_is_better = false,
                 .role = RateRole::kRemoved,
                 .nothing_removed = 1.0,
                 .everything_removed = 0.0,
                 .moving_points_removed = 0.0},
                {.name = "mistakes",
                 .unit = RateUnit::kFraction,
                 .decimals = 5,
                 .higher_is_better = false,
                 .role = RateRole::kHeadline,
                 .moving_points_removed = 0.0,
                 .note = "mistakes counts left and lost points together."},
                {.name = "lost_of_all",
                 .unit = RateUnit::kFraction,
                 .decimals = 5,
                 .higher_is_better = false}},
      .counts = {{"toy_moving", true}, {"toy_static", true}, {"toy_left"}, {"toy_lost"}},
      .open = [](const EvaluationInput& input, const Configuration&) -> std::unique_ptr<Scorer> {
        return std::make_unique<ToyScorer>(input);
      }};
}

/// The toy protocol is registered as long as this object lives.
struct RegisteredToy {
  RegisteredToy() { register_protocol(toy_protocol_entry()); }
  ~RegisteredToy() { unregister_protocol("toy"); }
  RegisteredToy(const RegisteredToy&) = delete;
  RegisteredToy& operator=(const RegisteredToy&) = delete;
};

}  // namespace raymoval::test
