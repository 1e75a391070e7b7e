// SPDX-License-Identifier: MIT
#include "eval/confidence/reliability.h"

#include <cmath>
#include <string>

#include "core/error.h"
#include "eval/checked_scan.h"

namespace raymoval {
namespace {

double gap_of(const ReliabilityBin& bin) {
  return std::abs(*bin.mean_confidence() - *bin.moving_share());
}

}  // namespace

ReliabilityBin& ReliabilityBin::operator+=(const ReliabilityBin& other) {
  points += other.points;
  moving += other.moving;
  steps += other.steps;
  return *this;
}

std::optional<double> ReliabilityBin::mean_confidence() const {
  if (points == 0) return std::nullopt;
  return static_cast<double>(steps) / kConfidenceSteps / static_cast<double>(points);
}

std::optional<double> ReliabilityBin::moving_share() const {
  if (points == 0) return std::nullopt;
  return static_cast<double>(moving) / static_cast<double>(points);
}

Reliability& Reliability::operator+=(const Reliability& other) {
  for (std::size_t i = 0; i < bins.size(); ++i) bins[i] += other.bins[i];
  return *this;
}

std::optional<double> Reliability::expected_error() const {
  double sum = 0.0, points = 0.0;
  for (const ReliabilityBin& bin : bins) {
    if (bin.points == 0) continue;
    sum += static_cast<double>(bin.points) * gap_of(bin);
    points += static_cast<double>(bin.points);
  }
  if (points == 0.0) return std::nullopt;
  return sum / points;
}

std::optional<double> Reliability::mean_gap() const {
  double sum = 0.0;
  int count = 0;
  for (const ReliabilityBin& bin : bins) {
    if (bin.points < kFewestInBin) continue;
    sum += gap_of(bin);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

ReliabilityCount::ReliabilityCount(const EvaluationInput& input, const ConfidenceStore& confidence)
    : input_(input), confidence_(confidence) {
  check_input(input, "a confidence");
  if (confidence.steps.size() == input.scans->size()) return;
  throw MethodError("there is a confidence for " + std::to_string(confidence.steps.size()) +
                    " scans, expected one for each of " + std::to_string(input.scans->size()) +
                    ".");
}

bool ReliabilityCount::begin_pass(std::size_t slots) {
  const bool is_first = slots_.empty();
  slots_.resize(slots);
  return is_first;
}

void ReliabilityCount::read(const CheckedScan& scan, std::size_t slot) {
  slots_[slot] = {};
  const std::string steps = confidence_.steps.get(scan.scan.index);
  if (steps.size() != scan.scan.size()) {
    throw MethodError("there is a confidence for " + std::to_string(steps.size()) +
                      " points of scan " + std::to_string(scan.scan.index) +
                      ", expected one for each of " + std::to_string(scan.scan.size()) + ".");
  }
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const LabelClass label = input_.label_rule.classify(scan.labels[k]);
    if (label == LabelClass::kIgnored) continue;
    if (!input_.range_m.contains(scan.scan.points[k].cast<double>().norm())) continue;
    const auto said = static_cast<std::uint8_t>(steps[k]);
    slots_[slot].bins[confidence_bin(said)] += {1, label == LabelClass::kMoving ? 1 : 0, said};
  }
}

void ReliabilityCount::take(std::size_t slot) {
  all_ += slots_[slot];
}

}  // namespace raymoval
