// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "eval/checked_scan.h"
#include "eval/points/labelled_voxels.h"
#include "eval/protocol_registry.h"

namespace raymoval::test {

/// Counts points by index. All of its rates are fractions of mistakes, so lower is better.
class ToyScoring : public Scoring {
 public:
  explicit ToyScoring(const LabelRule& rule) : classes_(rule) {}

  bool begin_pass(std::size_t slots) override {
    const bool is_first = slots_.empty();
    slots_.resize(slots);
    return is_first;
  }
  void read(const CheckedScan& scan, std::size_t slot) override {
    Counts counts;
    for (std::size_t p = 0; p < scan.labels.size(); ++p) {
      const bool moves = classes_.moving(scan.labels[p]);
      ++(moves ? counts.moving : counts.still);
      if (moves != scan.removed(p)) ++(moves ? counts.left : counts.lost);
    }
    slots_[slot] = counts;
  }
  void take(std::size_t slot) override {
    all_.moving += slots_[slot].moving;
    all_.still += slots_[slot].still;
    all_.left += slots_[slot].left;
    all_.lost += slots_[slot].lost;
  }
  ProtocolResult result() override {
    ProtocolResult result;
    result.protocol = "toy";
    result.counts = {{"toy_moving", all_.moving},
                     {"toy_static", all_.still},
                     {"toy_left", all_.left},
                     {"toy_lost", all_.lost}};
    const auto add = [&](const char* name, std::int64_t part, std::int64_t whole) {
      Rate rate = percent_rate(name, part, whole, "there is no such point");
      if (rate.value) *rate.value /= 100.0;
      result.rates.push_back(rate);
    };
    add("lost", all_.lost, all_.still);
    add("left", all_.left, all_.moving);
    add("mistakes", all_.left + all_.lost, all_.moving + all_.still);
    add("lost_of_all", all_.lost, all_.moving + all_.still);
    return result;
  }

 private:
  struct Counts {
    std::int64_t moving = 0, still = 0, left = 0, lost = 0;
  };
  LabelClasses classes_;
  std::vector<Counts> slots_;
  Counts all_;
};

class ToyScorer : public Scorer {
 public:
  using Scorer::Scorer;
  [[nodiscard]] std::unique_ptr<Scoring> start() const override {
    return std::make_unique<ToyScoring>(input().label_rule);
  }
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
