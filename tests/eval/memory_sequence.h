// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/scan/mask_store.h"
#include "core/scan/scan_source.h"
#include "eval/protocol_registry.h"

namespace raymoval::test {

/// One scan with its labels and the mask to score.
struct LabelledScan {
  Pose pose = Pose::Identity();
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> labels;
  Mask mask;

  void add(float x, float y, float z, std::uint32_t label, bool flagged = false) {
    points.emplace_back(x, y, z);
    labels.push_back(label);
    mask.push_back(flagged ? 1 : 0);
  }
};

/// The scan with its points in another order.
inline LabelledScan shuffled(const LabelledScan& scan, std::mt19937& random) {
  std::vector<std::size_t> order(scan.points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), random);
  LabelledScan other;
  other.pose = scan.pose;
  for (const std::size_t i : order) {
    const Eigen::Vector3f& p = scan.points[i];
    other.add(p.x(), p.y(), p.z(), scan.labels[i], scan.mask[i] != 0);
  }
  return other;
}

/// A sequence that lives in memory.
class MemorySequence : public ScanSource, public LabelSource {
 public:
  explicit MemorySequence(std::vector<LabelledScan> scans) : scans_(std::move(scans)) {}

  [[nodiscard]] std::size_t size() const override { return scans_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan;
    scan.index = index;
    scan.name = "frame " + std::to_string(index);
    scan.T_world_sensor = scans_[index].pose;
    scan.points = scans_[index].points;
    scan.stored_point_count = scan.points.size();
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t index) const override { return scans_[index].pose; }
  [[nodiscard]] const SensorModel& sensor() const override { return sensor_; }
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    return scans_[scan.index].labels;
  }

  [[nodiscard]] const std::vector<LabelledScan>& scans() const { return scans_; }
  [[nodiscard]] EvaluationInput input() const {
    EvaluationInput input;
    input.scans = this;
    input.labels = this;
    return input;
  }
  /// The masks of the scans.
  [[nodiscard]] MaskStore masks() const {
    return masks_of([](const LabelledScan& scan, std::size_t i) { return scan.mask[i] != 0; });
  }
  [[nodiscard]] MaskStore constant_masks(bool removed) const {
    return masks_of([removed](const LabelledScan&, std::size_t) { return removed; });
  }
  /// Flags exactly the points that move by `rule`.
  [[nodiscard]] MaskStore oracle_masks(const LabelRule& rule = {}) const {
    return masks_of([&rule](const LabelledScan& scan, std::size_t i) {
      return rule.classify(scan.labels[i]) == LabelClass::kMoving;
    });
  }

 private:
  template <class Flagged>
  [[nodiscard]] MaskStore masks_of(Flagged&& flagged) const {
    MaskStore masks(scans_.size());
    for (std::size_t s = 0; s < scans_.size(); ++s) {
      Mask mask(scans_[s].points.size());
      for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = flagged(scans_[s], i) ? 1 : 0;
      masks.set(s, mask);
    }
    return masks;
  }

  std::vector<LabelledScan> scans_;
  SensorModel sensor_;
};

using Settings = std::vector<std::pair<std::string, ParameterValue>>;

inline std::unique_ptr<Protocol> protocol_with(const std::string& name,
                                               const Settings& settings = {}) {
  Configuration options = protocol_defaults(name);
  for (const auto& [key, value] : settings) set_parameter(options, key, value);
  return make_protocol(name, options);
}

inline ProtocolResult score_by(const std::string& name, const EvaluationInput& input,
                               const MaskStore& masks, const Settings& settings = {}) {
  return protocol_with(name, settings)->open(input)->score(masks);
}

inline const Rate& rate_named(const ProtocolResult& result, const std::string& name) {
  for (const Rate& rate : result.rates) {
    if (rate.name == name) return rate;
  }
  throw InternalError("no rate " + name);
}

inline std::unique_ptr<Protocol> erasor_protocol(const Settings& settings = {}) {
  return protocol_with("erasor", settings);
}

inline ProtocolResult score_erasor(const EvaluationInput& input, const MaskStore& masks,
                                   const Settings& settings = {}) {
  return score_by("erasor", input, masks, settings);
}

}  // namespace raymoval::test
