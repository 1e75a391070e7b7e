// SPDX-License-Identifier: MIT
//
// Finds the curve that makes a confidence of a method's evidence (methods/calibration.h):
//   calibrate METHOD SEQUENCE [SEQUENCE ...]
//   calibrate raymoval_plus:offline town:seed=301,scans=60 crossing:seed=301,scans=60
// Runs the method on labelled sequences, counts which share of the points of equal evidence moves,
// fits the ascending curve that is likeliest (isotonic regression by pooling adjacent violators),
// and leaves of it the few knots that lose least. Prints them as they stand in a method's entry,
// and before that how well the curve that the entry has now fits these sequences. Every sequence
// weighs the same.
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <iostream>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/scan/confidence_store.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "eval/confidence/reliability.h"
#include "methods/registry.h"

namespace {

using raymoval::LabelClass;

constexpr std::size_t kCells = 2000;  ///< Evidence is counted in so many steps.
constexpr std::size_t kKnots = 14;

/// Points of about equal evidence.
struct Group {
  double points = 0.0, moving = 0.0, evidence = 0.0;  ///< The last is a sum.

  void add(const Group& other) {
    points += other.points;
    moving += other.moving;
    evidence += other.evidence;
  }
  [[nodiscard]] double share() const { return moving / points; }
};

using Groups = std::vector<Group>;

/// Counts the points of a sequence by evidence.
class Count : public raymoval::EvidenceSink, public raymoval::RemovalSink {
 public:
  Count(const raymoval::Sequence& sequence, const raymoval::ScanSource& scans)
      : sequence_(sequence), scans_(scans), groups(kCells + 1) {}

  void accept(std::size_t /*scan*/, const raymoval::Mask& /*mask*/) override {}
  void accept(std::size_t index, std::span<const float> evidence) override {
    const raymoval::Scan scan = scans_.load(index);
    const std::vector<std::uint32_t> labels = sequence_.labels->labels(scan);
    const std::lock_guard lock(mutex_);
    for (std::size_t k = 0; k < evidence.size(); ++k) {
      const LabelClass label = sequence_.label_rule.classify(labels[k]);
      if (label == LabelClass::kIgnored) continue;
      const double value = evidence[k];
      groups[static_cast<std::size_t>(std::lround(value * kCells))].add(
          {1.0, label == LabelClass::kMoving ? 1.0 : 0.0, value});
    }
  }

 private:
  const raymoval::Sequence& sequence_;
  const raymoval::ScanSource& scans_;
  std::mutex mutex_;

 public:
  Groups groups;
};

Groups count_points(const raymoval::ConfiguredMethod& method, const std::string& path) {
  const int threads = raymoval::hardware_threads();
  const raymoval::Sequence sequence =
      raymoval::open_sequence(path, {}, {threads, nullptr, nullptr, false});
  if (sequence.labels == nullptr) {
    throw raymoval::DataError(path + ": has no labels; expected a sequence that says what moves.");
  }
  const raymoval::LocalFrameSource local(*sequence.scans, sequence.method_frame());
  Count count(sequence, *sequence.scans);
  raymoval::RunContext context;
  context.threads = threads;
  context.evidence = &count;
  method.make()->run(local, count, context);
  double points = 0.0;
  for (const Group& group : count.groups) points += group.points;
  if (points == 0.0) {
    throw raymoval::UsageError(method.full_name() + " gave no evidence of " + path +
                               "; expected a method that asks for RunContext::evidence.");
  }
  for (Group& group : count.groups) {
    group.points /= points;
    group.moving /= points;
    group.evidence /= points;
  }
  return count.groups;
}

/// Isotonic regression.
Groups ascending(const Groups& groups) {
  Groups pooled;
  for (const Group& group : groups) {
    if (group.points == 0.0) continue;
    pooled.push_back(group);
    while (pooled.size() > 1 && pooled.back().share() <= pooled[pooled.size() - 2].share()) {
      pooled[pooled.size() - 2].add(pooled.back());
      pooled.pop_back();
    }
  }
  return pooled;
}

/// The log-likelihood of a group's points under their own share.
double likelihood(const Group& group) {
  const double share = group.share();
  if (share <= 0.0 || share >= 1.0) return 0.0;
  return group.points * (share * std::log(share) + (1.0 - share) * std::log(1.0 - share));
}

/// Joins neighbours where that costs least, until few are left.
void join(Groups& groups) {
  while (groups.size() > kKnots) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < groups.size(); ++i) {
      Group both = groups[i];
      both.add(groups[i + 1]);
      const double cost = likelihood(groups[i]) + likelihood(groups[i + 1]) - likelihood(both);
      if (cost >= least) continue;
      least = cost;
      best = i;
    }
    groups[best].add(groups[best + 1]);
    groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(best) + 1);
  }
}

std::string text_of(const std::optional<double>& value, int decimals) {
  return value ? raymoval::fixed_text(*value, decimals) : "-";
}

/// What the curve of the method's entry says of the groups, and what is true. Points are those of a
/// sequence of a hundred million, as every sequence weighs the same.
void print_reliability(const Groups& groups, const raymoval::Calibration& calibration) {
  constexpr double kPoints = 1e8;
  raymoval::Reliability all;
  double weight = 0.0;
  for (const Group& group : groups) weight += group.points;
  for (const Group& group : groups) {
    if (group.points == 0.0) continue;
    const auto points = std::llround(kPoints * group.points / weight);
    const auto moving = std::llround(kPoints * group.moving / weight);
    const auto evidence = static_cast<float>(group.evidence / group.points);
    const std::uint8_t steps = raymoval::confidence_steps(calibration.confidence(evidence));
    all.bins[raymoval::confidence_bin(steps)] += {points, moving, points * steps};
  }
  std::cout << "| said | % of points | mean said | share that moves |\n|---|---:|---:|---:|\n";
  for (std::size_t i = 0; i < raymoval::kConfidenceBins; ++i) {
    const raymoval::ReliabilityBin& bin = all.bins[i];
    std::cout << "| 0." << i << " to " << raymoval::fixed_text(0.1 * static_cast<double>(i + 1), 1)
              << " | " << raymoval::fixed_text(100.0 * static_cast<double>(bin.points) / kPoints, 3)
              << " | " << text_of(bin.mean_confidence(), 3) << " | "
              << text_of(bin.moving_share(), 3) << " |\n";
  }
  std::cout << "Expected calibration error " << text_of(all.expected_error(), 5) << ", mean gap "
            << text_of(all.mean_gap(), 3) << ".\n\n";
}

void calibrate(const std::vector<std::string>& arguments) {
  const raymoval::ConfiguredMethod method =
      raymoval::MethodRegistry::built_in().configure(arguments.front());
  Groups all(kCells + 1);
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const Groups one = count_points(method, arguments[i]);
    for (std::size_t k = 0; k < one.size(); ++k) all[k].add(one[k]);
  }
  if (!method.entry->confidence.empty()) print_reliability(all, method.entry->confidence);
  Groups curve = ascending(all);
  join(curve);
  for (const Group& group : curve) {
    std::cout << "{" << raymoval::fixed_text(group.evidence / group.points, 4) << "F, "
              << raymoval::fixed_text(group.share(), 4) << "F},  // "
              << raymoval::fixed_text(
                     100.0 * group.points / static_cast<double>(arguments.size() - 1), 4)
              << " % of points\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() < 2) {
    std::cerr << "usage: calibrate METHOD SEQUENCE [SEQUENCE ...]\n";
    return 2;
  }
  try {
    calibrate(arguments);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "calibrate: " << error.what() << '\n';
    return 2;
  }
}
